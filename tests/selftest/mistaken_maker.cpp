// SPDX-License-Identifier: Apache-2.0
#include "selftest/mistaken_maker.h"

#include <glm/geometric.hpp>
#include <vector>

namespace lamina::selftest {
namespace {

TransferFunction with_more_extinction(const TransferFunction& transfer_function) {
    std::vector<TransferKnot> knots(transfer_function.knots().begin(),
                                    transfer_function.knots().end());
    for (TransferKnot& knot : knots) knot.optics.extinction *= 1.01;
    return TransferFunction::linear(knots);
}

}  // namespace

PreciseImage MistakenMaker::draw(const Scene& scene, const SceneData& data,
                                 FrameStatistics* statistics) const {
    return PictureMaker::draw(mistaken(scene), data, statistics);
}

Scene MistakenMaker::mistaken(Scene scene) const {
    switch (mistake_) {
        case Mistake::extinction:
            scene.transfer_function = with_more_extinction(*scene.transfer_function);
            break;
        case Mistake::position:
            scene.camera->eye += 1e-3 * glm::length(scene.camera->center - scene.camera->eye) *
                                 glm::dvec3(.6, -.48, .64);
            break;
        case Mistake::slabs:
            if (scene.slice.samples.value_or(1) > 1) --*scene.slice.samples;
            break;
        case Mistake::thickness:
            scene.project.thickness = Thickness::dz;
            break;
        case Mistake::order:
            scene.project.order = ProjectOrder::none;
            break;
        case Mistake::clip:
            for (ClipPlane& plane : scene.clip.planes)
                plane.point += 1e-3 * glm::normalize(plane.normal);
            break;
        case Mistake::light:
            if (scene.lighting) (*scene.lighting)->ambient += .01;
            break;
        case Mistake::bits:
            if (scene.target == Target::emulated) scene.emulate.bits -= 2;
            break;
    }
    return scene;
}

}  // namespace lamina::selftest
