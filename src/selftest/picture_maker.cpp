// SPDX-License-Identifier: Apache-2.0
#include "selftest/picture_maker.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <memory>
#include <utility>

#include "base/error.h"
#include "mesh/face_tree.h"
#include "projection/project_renderer.h"
#include "reference/mesh_tracer.h"
#include "reference/volume_tracer.h"
#include "render/scene_renderer.h"

namespace lamina::selftest {
namespace {

PreciseImage to_precise(const Image& image) {
    PreciseImage precise(image.width, image.height);
    std::copy(image.rgba.begin(), image.rgba.end(), precise.rgba.begin());
    return precise;
}

TransferFunction with_more_extinction(const TransferFunction& transfer_function) {
    std::vector<TransferKnot> knots(transfer_function.knots().begin(),
                                    transfer_function.knots().end());
    for (TransferKnot& knot : knots) knot.optics.extinction *= 1.01;
    return TransferFunction::linear(knots);
}

}  // namespace

PictureMaker::PictureMaker(const Capabilities& capabilities, std::string mistake)
    : capabilities_(capabilities), mistake_(std::move(mistake)) {
    const auto& known = mistakes();
    if (!mistake_.empty() && std::ranges::find(known, mistake_) == known.end())
        throw UsageError(fmt::format("LAMINA_SELFTEST_MISTAKE: found \"{}\", expected one of {}",
                                     mistake_, fmt::join(known, ", ")));
}

const std::vector<std::string>& PictureMaker::mistakes() {
    static const std::vector<std::string> names{"extinction", "position", "slabs",
                                                "thickness",  "order",    "bits"};
    return names;
}

// What a wrong renderer would do, each in its way: opacities corrected wrongly, rays off by 1e-3 of
// their distance, a slab too few, Kraus's thickness along the depth axis, no visibility order, two
// bits too few.
Scene PictureMaker::mistaken(Scene scene) const {
    if (mistake_ == "extinction")
        scene.transfer_function = with_more_extinction(scene.transfer_function);
    if (mistake_ == "position")
        scene.camera.eye +=
            1e-3 * glm::length(scene.camera.center - scene.camera.eye) * glm::dvec3(.6, -.48, .64);
    if (mistake_ == "slabs" && scene.slice.samples && *scene.slice.samples > 1)
        --*scene.slice.samples;
    if (mistake_ == "thickness") scene.project.thickness = Thickness::dz;
    if (mistake_ == "order") scene.project.order = ProjectOrder::none;
    if (mistake_ == "bits" && scene.target == Target::emulated) scene.emulate.bits -= 2;
    return scene;
}

PreciseImage PictureMaker::draw(const Scene& asked, const Volume& volume) const {
    const Scene scene = mistaken(asked);
    const View view(scene.camera, scene.width, scene.height);
    if (scene.method == Method::trace)
        return trace_volume(volume, scene.transfer_function, view, {scene.trace_tolerance}).image;
    SceneRenderer session(scene, std::make_shared<const VolumeData>(volume), capabilities_);
    return to_precise(session.draw_picture());
}

PreciseImage PictureMaker::draw(const Scene& asked, const SceneMesh& mesh,
                                OrderReport* order) const {
    const Scene scene = mistaken(asked);
    const View view(scene.camera, scene.width, scene.height);
    if (scene.method == Method::trace) {
        const FaceTree open_faces(mesh.mesh, mesh.mesh.open_faces());
        return trace_mesh(mesh.mesh, open_faces, mesh.scalar.values, scene.transfer_function, view)
            .image;
    }
    // The mesh is the caller's, and outlives the session.
    SceneRenderer session(scene, std::shared_ptr<const SceneMesh>(std::shared_ptr<void>(), &mesh),
                          capabilities_);
    session.draw();
    if (order) *order = dynamic_cast<const ProjectRenderer&>(session.renderer()).order_report();
    return to_precise(session.picture());
}

}  // namespace lamina::selftest
