// SPDX-License-Identifier: Apache-2.0
#include "render/traced_picture.h"

#include <utility>

#include "base/stage.h"
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

}  // namespace lamina
