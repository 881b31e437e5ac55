// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tbb/task_arena.h>

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "base/client.h"
#include "lamina/session.h"
#include "render/draw_context.h"
#include "render/scene_renderer.h"
#include "render/volume_data.h"
#include "scene/scene_mesh.h"

namespace lamina {

// What a session holds: the data of its scene, as far as a method has asked for them, and the
// renderer of the method that was drawn last.
struct Session::Parts {
    Parts(Scene first, const SessionOptions& options);
    ~Parts();

    // Calls work() for the session's client: in its threads, its context current, its warnings
    // kept.
    template <typename Work>
    void run(const Work& work, std::stop_token stop = {}, const ProgressCallback& progress = {}) {
        const WarningTaker taker = [this](const std::string& text) { keep_warning(text); };
        ProgressListener listener{progress};
        threads.execute([&] {
            const ClientScope scope({std::move(stop), &taker, &listener});
            const auto current = context ? context->make_current() : nullptr;
            work();
        });
    }

    void keep_warning(const std::string& text);
    const VolumeData& volume_data();
    const SceneMesh& mesh_data();
    SceneRenderer& renderer();  // of Method::slice or project
    void open_context();
    void draw();
    void trace();

    // A mesh that is made from a volume follows the transfer function.
    bool makes_mesh() const { return !mesh_given && scene.mesh_file.empty(); }
    void forget_made_mesh();
    void forget_renderer();

    Scene scene;
    ContextChoice choice;
    tbb::task_arena threads;
    std::unique_ptr<DrawContext> context;
    std::shared_ptr<const VolumeData> volume;
    std::shared_ptr<const SceneMesh> mesh;
    bool mesh_given = false;
    std::unique_ptr<SceneRenderer> drawn;
    Image picture;
    PreciseImage truth;
    FrameStatistics statistics;
    std::mutex keeping;
    std::vector<std::string> warnings;
};

}  // namespace lamina
