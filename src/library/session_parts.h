// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tbb/task_arena.h>

#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "base/client.h"
#include "choice/field.h"
#include "lamina/session.h"
#include "render/draw_context.h"
#include "render/scene_renderer.h"
#include "scene/scene_mesh.h"
#include "volume/volume_data.h"

namespace lamina {

// Throws Error where there is no such view: scene files are checked for that when they are read.
void check_view(const Camera& camera, int width, int height);

// A session holds the data of its scene, as far as a method has asked for them, and the renderer of
// the method that was drawn last.
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
            const ClientScope scope({std::move(stop), &taker, &listener, only_below});
            const auto current = context ? context->make_current() : nullptr;
            work();
        });
    }

    // The same where a context is needed.
    template <typename Work>
    void run_drawing(const Work& work, std::stop_token stop = {},
                     const ProgressCallback& progress = {}) {
        if (!context) open_context(stop, progress);
        run(work, std::move(stop), progress);
    }

    void open_context(const std::stop_token& stop, const ProgressCallback& progress);
    void keep_warning(const std::string& text);
    const VolumeData& volume_data();
    const SceneMesh& mesh_data();
    SceneRenderer& renderer();  // of Method::slice or project
    void draw(Image& into);
    void trace(const TileCallback& tile_done);

    // The scene that was asked for, with what it leaves open chosen from the data that it draws.
    Scene chosen();
    // Calls work(const Field&) with the data that the scene draws.
    template <typename Work>
    void with_field(const Work& work);
    ValueHistogram histogram(int bins);
    // Warns of what `picture` lacks.
    void warn_of(const Image& picture);

    // Replaces the scene that is drawn, and forgets the mesh and the renderer where these are not
    // of the next.
    void take_scene(Scene next);
    bool changes_mesh(const Scene& next) const;

    Scene asked;  // as the user has it
    Scene scene;  // with nothing automatic in transfer function and camera
    ContextChoice choice;
    std::shared_ptr<const std::filesystem::path> only_below;
    tbb::task_arena threads;
    bool many_frames;
    std::unique_ptr<DrawContext> context;
    std::shared_ptr<const VolumeData> volume;
    std::shared_ptr<const SceneMesh> mesh;
    bool mesh_given = false;
    std::unique_ptr<SceneRenderer> drawn;
    // Of the data that the histogram was last asked of.
    std::weak_ptr<const void> counted;
    ValueDistribution counts;
    Image picture;
    PreciseImage truth;
    FrameStatistics statistics, trace_statistics;
    std::mutex keeping;
    std::vector<std::string> warnings;
};

}  // namespace lamina
