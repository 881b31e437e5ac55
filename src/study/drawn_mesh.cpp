// SPDX-License-Identifier: Apache-2.0
#include "study/drawn_mesh.h"

#include <utility>

#include "reference/mesh_tracer.h"

namespace lamina {
namespace {

std::vector<double> seen_in(const Scene& scene) {
    std::vector<double> seen{static_cast<double>(scene.camera.projection), scene.camera.fov_y,
                             scene.camera.height, static_cast<double>(scene.width),
                             static_cast<double>(scene.height)};
    const auto add = [&](const glm::dvec3& v) { seen.insert(seen.end(), {v.x, v.y, v.z}); };
    add(scene.camera.eye);
    add(scene.camera.center);
    add(scene.camera.up);
    for (const TransferKnot& knot : scene.transfer_function.knots()) {
        seen.push_back(knot.value);
        add(knot.optics.color);
        seen.push_back(knot.optics.extinction);
    }
    return seen;
}

}  // namespace

DrawnMesh::DrawnMesh(SceneMesh mesh)
    : mesh_(std::move(mesh)), open_faces_(mesh_.mesh, mesh_.mesh.open_faces()) {}

std::unique_ptr<GlProjectRenderer> DrawnMesh::renderer(const Scene& scene,
                                                       const Capabilities& capabilities) const {
    const Plan plan = make_plan(scene, measure_for(scene), capabilities, {});
    return std::make_unique<GlProjectRenderer>(mesh_, scene.transfer_function, plan.project,
                                               capabilities, scene.width, scene.height);
}

Image DrawnMesh::draw(const Scene& scene, const Capabilities& capabilities) const {
    const auto drawing = renderer(scene, capabilities);
    drawing->draw(View(scene.camera, scene.width, scene.height));
    return drawing->read();
}

const PreciseImage& DrawnMesh::exact(const Scene& scene) {
    std::vector<double> seen = seen_in(scene);
    for (const Traced& traced : traced_) {
        if (traced.seen == seen) return traced.image;
    }
    MeshTraceResult result =
        trace_mesh(mesh_.mesh, open_faces_, mesh_.scalar.values, scene.transfer_function,
                   View(scene.camera, scene.width, scene.height));
    return traced_.emplace_back(Traced{std::move(seen), std::move(result.image)}).image;
}

}  // namespace lamina
