// SPDX-License-Identifier: Apache-2.0
#include "library/session_parts.h"

#include <utility>

#include "base/error.h"
#include "base/stage.h"
#include "base/unreachable.h"
#include "mesh/face_tree.h"
#include "reference/mesh_tracer.h"
#include "reference/volume_tracer.h"

namespace lamina {
namespace {

int arena_threads(int threads) {
    if (threads < 0) fail("threads: found {}, expected 0 (all) or more", threads);
    return threads == 0 ? tbb::task_arena::automatic : threads;
}

}  // namespace

Session::Parts::Parts(Scene first, const SessionOptions& options)
    : scene(std::move(first)),
      choice(options.context),
      threads(arena_threads(options.threads)),
      warnings(scene.warnings) {}

// What OpenGL holds goes while its context is current.
Session::Parts::~Parts() {
    if (drawn) run([&] { forget_renderer(); });
}

void Session::Parts::keep_warning(const std::string& text) {
    const std::lock_guard lock(keeping);
    warnings.push_back(text);
}

const VolumeData& Session::Parts::volume_data() {
    if (!volume) {
        if (!scene.has_volume()) fail("the session has no volume, and its scene names none");
        volume = std::make_shared<const VolumeData>(load_volume(scene));
    }
    return *volume;
}

const SceneMesh& Session::Parts::mesh_data() {
    if (!mesh) {
        mesh = std::make_shared<const SceneMesh>(
            makes_mesh() ? scene_mesh(scene, volume_data().volume) : load_mesh(scene));
    }
    return *mesh;
}

void Session::Parts::open_context() {
    if (context) return;
    threads.execute([&] { context = std::make_unique<DrawContext>(choice); });
}

SceneRenderer& Session::Parts::renderer() {
    if (drawn) return *drawn;
    switch (scene.method) {
        case Method::slice:
            volume_data();
            drawn = std::make_unique<SceneRenderer>(scene, volume, context->capabilities());
            return *drawn;
        case Method::project:
            mesh_data();
            drawn = std::make_unique<SceneRenderer>(scene, mesh, context->capabilities());
            return *drawn;
        case Method::trace:
            fail("render.method: \"trace\" has no plan, expected \"slice\" or \"project\"");
    }
    unreachable_enum();
}

void Session::Parts::draw() {
    SceneRenderer& frames = renderer();
    frames.draw();
    frames.read(picture);
    statistics.drawn_by = renderer_and_threads(context->capabilities());
    statistics.stages_ms = frames.stages_ms();
    for (const auto& [stage, ms] : frames.renderer().stages_ms()) statistics.stages_ms[stage] = ms;
    statistics.fragments = frames.renderer().fragments();
    statistics.bytes = frames.renderer().byte_count();
}

void Session::Parts::trace() {
    const View view(scene.camera, scene.width, scene.height);
    if (scene.draws_mesh()) {
        const SceneMesh& data = mesh_data();
        const FaceTree open_faces(data.mesh, data.mesh.open_faces());
        truth = trace_mesh(data.mesh, open_faces, data.scalar.values, scene.transfer_function, view)
                    .image;
    } else {
        truth = trace_volume(volume_data().volume, scene.transfer_function, view,
                             {scene.trace_tolerance})
                    .image;
    }
}

void Session::Parts::forget_renderer() {
    drawn.reset();
}

void Session::Parts::forget_made_mesh() {
    if (!makes_mesh()) return;
    mesh.reset();
    if (scene.method == Method::project) forget_renderer();
}

}  // namespace lamina
