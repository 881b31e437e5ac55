// SPDX-License-Identifier: Apache-2.0
#include "render/traced_picture.h"

#include <utility>

#include "base/profile.h"
#include "plain/plain_tracer.h"
#include "reference/scene_tracer.h"

namespace lamina {

Scene as_trace(Scene scene, TraceOf of) {
    scene.method = Method::trace;
    scene.trace_of = of;
    return scene;
}

TracedPicture trace_picture(const Scene& scene, SceneData& data, const TileDone& tile_done) {
    if (scene.draws_mesh()) {
        const SceneMesh& mesh = *data.mesh(scene);
        const FaceTree& open_faces = data.open_faces(scene);
        const Stage tracing("trace");
        MeshTraceResult traced = trace(scene, mesh, open_faces, tile_done);
        return {std::move(traced.image), traced.error_estimate, traced.segments,
                traced.overlapping_rays};
    }
    const Volume& volume = data.volume(scene)->volume;
    const Stage tracing("trace");
    TraceResult traced = trace(scene, volume, tile_done);
    return {std::move(traced.image), traced.error_estimate, traced.segments, 0};
}

TracedPicture plainly_traced_picture(const Scene& scene, SceneData& data) {
    const auto trace = [&](const auto& drawn) {
        const Stage tracing("trace");
        PlainPicture traced = trace_plainly(scene, drawn);
        return TracedPicture{std::move(traced.image), traced.error_estimate, traced.segments, 0};
    };
    return scene.draws_mesh() ? trace(*data.mesh(scene)) : trace(data.volume(scene)->volume);
}

}  // namespace lamina
