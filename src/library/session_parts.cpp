// SPDX-License-Identifier: Apache-2.0
#include "library/session_parts.h"

#include <algorithm>
#include <utility>

#include "base/error.h"
#include "base/unreachable.h"
#include "choice/binned_values.h"
#include "choice/choose.h"
#include "choice/mesh_field.h"
#include "choice/volume_field.h"
#include "reference/scene_tracer.h"
#include "render/context_choice.h"
#include "render/warnings.h"
#include "scene/camera.h"
#include "scene/lighting_check.h"
#include "scene/scene_volume.h"

namespace lamina {
namespace {

int arena_threads(int threads) {
    if (threads < 0) fail("threads: found {}, expected 0 (all) or more", threads);
    return threads == 0 ? tbb::task_arena::automatic : threads;
}

}  // namespace

void check_view(const Camera& camera, int width, int height) {
    if (width < 1 || height < 1)
        fail("image: found {} x {} pixels, expected 1 x 1 or more", width, height);
    View(camera, width, height);
}

Session::Parts::Parts(Scene first, const SessionOptions& options)
    : asked(std::move(first)),
      scene(asked),
      choice(options.context),
      only_below(allowed_folder(options.only_below)),
      threads(arena_threads(options.threads)),
      many_frames(options.many_frames),
      warnings(scene.warnings) {
    check_view(scene.camera, scene.width, scene.height);
    check_lighting(scene);
}

// The context must be current when a renderer of OpenGL is destroyed.
Session::Parts::~Parts() {
    if (drawn) run([&] { drawn.reset(); });
}

// The data decide, where they do not fit the memory.
void Session::Parts::open_context(const std::stop_token& stop, const ProgressCallback& progress) {
    ContextChoice for_data = choice;
    const auto choose_for_data = [&] {
        if (!volume_data().volume.in_memory()) for_data = context_for_files(choice);
    };
    if (scene.method == Method::slice && !scene.draws_mesh()) run(choose_for_data, stop, progress);
    threads.execute([&] { context = std::make_unique<DrawContext>(for_data); });
}

// A warning of a picture comes again with every picture.
void Session::Parts::keep_warning(const std::string& text) {
    const std::lock_guard lock(keeping);
    if (std::ranges::find(warnings, text) == warnings.end()) warnings.push_back(text);
}

const VolumeData& Session::Parts::volume_data() {
    if (!volume) {
        if (!scene.has_volume()) fail("the session has no volume, and its scene names none");
        volume = std::make_shared<const VolumeData>(open_volume(scene));
    }
    return *volume;
}

const SceneMesh& Session::Parts::mesh_data() {
    if (!mesh) {
        mesh = std::make_shared<const SceneMesh>(
            scene.mesh_file.empty() ? scene_mesh(scene, volume_data().volume) : load_mesh(scene));
    }
    return *mesh;
}

Scene Session::Parts::chosen() {
    if (!leaves_something_open(asked)) return asked;
    if (!asked.draws_mesh() || (!mesh_given && asked.mesh_file.empty())) {
        return choose(asked, VolumeField(volume_data()));
    }
    // The mesh may be one that an earlier scene made from the volume.
    if (!mesh_given && scene.mesh_file.empty()) mesh.reset();
    scene.mesh_file = asked.mesh_file;
    scene.mesh_time = asked.mesh_time;
    return choose(asked, MeshField(mesh_data()));
}

template <typename Work>
void Session::Parts::with_field(const Work& work) {
    if (scene.draws_mesh())
        work(MeshField(mesh_data()));
    else
        work(VolumeField(volume_data()));
}

ValueHistogram Session::Parts::histogram(int bins) {
    if (bins < 1) fail("histogram: found {} intervals, expected 1 or more", bins);
    ValueHistogram found;
    with_field([&](const Field& field) {
        const std::shared_ptr<const void> drawn_data =
            scene.draws_mesh() ? std::shared_ptr<const void>(mesh) : volume;
        if (counted.lock() != drawn_data) counts = field.distribution();
        counted = drawn_data;
        found = binned(counts, field.range(), field.whole_numbers(), bins);
    });
    return found;
}

void Session::Parts::warn_of(const Image& drawn_picture) {
    with_field([&](const Field& field) { warn_of_picture(scene, field, drawn_picture); });
}

SceneRenderer& Session::Parts::renderer() {
    if (drawn) return *drawn;
    switch (scene.method) {
        case Method::slice:
            volume_data();
            drawn = std::make_unique<SceneRenderer>(scene, volume, context->capabilities());
            if (many_frames) drawn->expect_many_frames();
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

void Session::Parts::draw(Image& into) {
    SceneRenderer& frames = renderer();
    frames.draw();
    frames.read(into);
    statistics = {};
    statistics.drawn_by = renderer_and_threads(context->capabilities());
    statistics.stages_ms = frames.stages_ms();
    for (const auto& [stage, ms] : frames.renderer().stages_ms()) statistics.stages_ms[stage] = ms;
    statistics.fragments = frames.renderer().fragments();
    statistics.bytes = frames.renderer().byte_count();
    warn_of_all(frames.warnings());
    warn_of(into);
}

void Session::Parts::trace(const TileCallback& tile_done) {
    trace_statistics = {};
    trace_statistics.drawn_by = "reference tracer";
    const auto keep = [&](auto traced) {
        truth = std::move(traced.image);
        trace_statistics.trace_error = 255 * traced.error_estimate;
    };
    if (scene.draws_mesh()) {
        auto traced = lamina::trace(scene, mesh_data(), tile_done);
        warn_of_all(data_warnings(scene, mesh_data()));
        warn_of_all(trace_warnings(traced.overlapping_rays));
        keep(std::move(traced));
    } else {
        keep(lamina::trace(scene, volume_data().volume, tile_done));
        warn_of_all(data_warnings(volume_data()));
    }
    warn_of(to_float(truth));
}

// A mesh that is made from a volume depends on the transfer function.
bool Session::Parts::changes_mesh(const Scene& next) const {
    if (mesh_given) return false;
    const bool made = scene.mesh_file.empty(), makes = next.mesh_file.empty();
    return made != makes || (makes && (next.mesh_request != scene.mesh_request ||
                                       next.transfer_function != scene.transfer_function));
}

void Session::Parts::take_scene(Scene next) {
    const bool other_method = next.method != scene.method, other_mesh = changes_mesh(next);
    scene = std::move(next);
    if (other_mesh) mesh.reset();
    if (other_method || (other_mesh && scene.method == Method::project)) drawn.reset();
}

}  // namespace lamina
