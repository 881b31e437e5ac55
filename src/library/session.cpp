// SPDX-License-Identifier: Apache-2.0
#include "lamina/session.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/client.h"
#include "base/error.h"
#include "base/profile.h"
#include "choice/value_distribution.h"
#include "choice/words.h"
#include "lamina/sampling.h"
#include "lamina/scene.h"
#include "mesh/face_tree.h"
#include "reference/tracer.h"
#include "render/pipeline.h"
#include "scene/camera.h"
#include "scene/clip.h"
#include "scene/scene.h"
#include "volume/volume_data.h"

namespace lamina {
namespace {

// Throws Error if no picture has this camera and size. Scenes from files were checked when read.
void check_view(const Camera& camera, int width, int height) {
    if (width < 1 || height < 1)
        fail("image: found {} x {} pixels, expected 1 x 1 or more", width, height);
    View(camera, width, height);
}

int arena_threads(int threads) {
    if (threads < 0) fail("threads: found {}, expected 0 (all) or more", threads);
    return threads == 0 ? tbb::task_arena::automatic : threads;
}

}  // namespace

// A session: the pipeline of its scene, with the client's threads, the folder that it may read, and
// the warnings that it has not yet taken.
struct Session::Parts {
    Parts(Scene scene, const SessionOptions& options)
        : only_below(allowed_folder(options.only_below)), threads(arena_threads(options.threads)) {
        check_view(scene.camera.value_or({}), scene.width, scene.height);
        check_lighting(scene);
        pipeline = std::make_unique<Pipeline>(
            std::move(scene), SceneData(),
            PipelineOptions{.context = options.context, .many_frames = options.many_frames});
        pipeline->data().keep_volume();
    }

    // Returns work(), done in the session's threads, with its warnings kept. Each picture repeats
    // its warnings, so equal texts are kept once.
    template <typename Work>
    auto run(const Work& work, std::stop_token stop = {}, const ProgressCallback& progress = {}) {
        const WarningTaker taker = [this](const std::string& text) {
            const std::lock_guard lock(keeping);
            if (std::ranges::find(warnings, text) == warnings.end()) warnings.push_back(text);
        };
        ProgressListener listener{progress};
        return threads.execute([&] {
            const ClientScope scope({std::move(stop), &taker, &listener, only_below});
            return work();
        });
    }

    ~Parts() {
        run([&] { pipeline.reset(); });
    }

    std::shared_ptr<const std::filesystem::path> only_below;
    tbb::task_arena threads;
    std::mutex keeping;
    std::vector<std::string> warnings;
    std::unique_ptr<Pipeline> pipeline;
    std::weak_ptr<const void> counted;  // data that `counts` belongs to
    ValueDistribution counts;
    Image picture;
    FrameStatistics statistics, trace_statistics;
};

// Data of the probed scene: either the volume or the mesh is set.
struct PointProbe::Parts {
    Scene scene;
    std::shared_ptr<const VolumeData> volume;
    std::shared_ptr<const SceneMesh> mesh;
    std::once_flag first;
    std::optional<FaceTree> open_faces;  // of the mesh; made on the first probe
};

Session::Session(Scene scene, SessionOptions options)
    : parts_(std::make_unique<Parts>(std::move(scene), options)) {
    parts_->run([&] { parts_->pipeline->load(); }, options.stop);
}

Session::Session(Scene scene, Volume volume, SessionOptions options)
    : parts_(std::make_unique<Parts>(std::move(scene), options)) {
    parts_->run(
        [&] {
            parts_->pipeline->data() = SceneData(std::move(volume));
            parts_->pipeline->scene();
        },
        options.stop);
}

Session::Session(Scene scene, MeshData mesh, SessionOptions options)
    : parts_(std::make_unique<Parts>(std::move(scene), options)) {
    parts_->run(
        [&] {
            Pipeline& pipeline = *parts_->pipeline;
            pipeline.data() = SceneData(pipeline.asked(), std::move(mesh));
            pipeline.scene();
        },
        options.stop);
}

Session::~Session() = default;
Session::Session(Session&& other) noexcept = default;
Session& Session::operator=(Session&& other) noexcept = default;

void Session::set_camera(const Camera& camera) {
    const Scene& now = chosen_scene();
    check_view(camera, now.width, now.height);
    parts_->pipeline->set_camera(camera);
}

void Session::set_size(int width, int height) {
    check_view(*chosen_scene().camera, width, height);
    parts_->pipeline->set_size(width, height);
}

void Session::set_transfer_function(const TransferFunction& transfer_function) {
    parts_->run([&] { parts_->pipeline->set_transfer_function(transfer_function); });
}

void Session::set_transfer_function_of(const Scene& like) {
    parts_->run([&] { parts_->pipeline->set_transfer_function_of(like); });
}

void Session::set_clip(const Clip& clip) {
    half_spaces(clip);  // throws if a plane or box is invalid
    parts_->run([&] { parts_->pipeline->set_clip(clip); });
}

void Session::set_scene(Scene scene) {
    check_view(scene.camera.value_or({}), scene.width, scene.height);
    check_lighting(scene);
    parts_->run([&] { parts_->pipeline->set_scene(std::move(scene)); });
}

void Session::choose_again() {
    set_scene(scene());
}

void Session::adjust(const Words& words) {
    parts_->run([&] {
        Pipeline& pipeline = *parts_->pipeline;
        pipeline.adjust(adjustments_of(words, pipeline.asked().color_space));
    });
}

const Scene& Session::scene() const {
    return parts_->pipeline->asked();
}

const Scene& Session::chosen_scene() const {
    return parts_->pipeline->scene();
}

const Scene& Session::resolved_scene() {
    return *parts_->run([&] { return &parts_->pipeline->resolved_scene(); });
}

void Session::save_resolved_scene(const std::filesystem::path& file) {
    const Scene& resolved = resolved_scene();
    if (!resolved.has_volume() && !resolved.has_mesh()) {
        fail("{}: the scene names no data; expected a volume or a mesh, to say where they are",
             file.string());
    }
    save_scene(resolved, file);
}

PlanSummary Session::plan() {
    return parts_->run([&] {
        PlanSummary summary;
        if (chosen_scene().method == Method::trace)
            fail("render.method: \"trace\" has no plan, expected \"slice\" or \"project\"");
        const Plan& plan = parts_->pipeline->plan();
        summary.method = plan.method;
        if (plan.method == Method::slice) {
            summary.target = plan.slice.target;
            summary.slabs = plan.slice.slabs;
        } else {
            summary.target = plan.project.target;
        }
        summary.error = plan.error();
        for (const Omission& omission : plan.omitted)
            summary.left_out.push_back({omission.name, omission.reason});
        return summary;
    });
}

std::string Session::explanation() {
    return parts_->run([&] { return parts_->pipeline->explanation(); });
}

const Image& Session::draw(std::stop_token stop, const ProgressCallback& progress) {
    draw(parts_->picture, std::move(stop), progress);
    return parts_->picture;
}

void Session::draw(Image& picture, std::stop_token stop, const ProgressCallback& progress) {
    Stopwatch watch;
    parts_->run(
        [&] {
            parts_->pipeline->draw(picture);
            parts_->statistics = parts_->pipeline->statistics();
            if (chosen_scene().method == Method::trace)
                parts_->trace_statistics = parts_->statistics;
        },
        std::move(stop), progress);
    parts_->statistics.draw_ms = 1e3 * watch.seconds();
}

const PreciseImage& Session::trace(std::stop_token stop, const ProgressCallback& progress,
                                   const TileCallback& tile_done) {
    Stopwatch watch;
    const PreciseImage* const truth = parts_->run(
        [&] {
            const PreciseImage& traced = parts_->pipeline->trace(tile_done).image;
            parts_->trace_statistics = parts_->pipeline->trace_statistics();
            parts_->pipeline->warn_of(to_float(traced));
            return &traced;
        },
        std::move(stop), progress);
    parts_->trace_statistics.draw_ms = 1e3 * watch.seconds();
    return *truth;
}

Grid::Bounds Session::bounds() {
    return parts_->run([&]() -> Grid::Bounds {
        const Scene& scene = parts_->pipeline->scene();
        SceneData& data = parts_->pipeline->data();
        if (!scene.draws_mesh()) return data.volume(scene)->volume.grid().bounds();
        const auto& [min, max] = data.mesh(scene)->mesh.bounds();
        return {min, max};
    });
}

PointProbe Session::probe() {
    auto probe = std::make_shared<PointProbe::Parts>();
    parts_->run([&] {
        probe->scene = parts_->pipeline->scene();
        SceneData& data = parts_->pipeline->data();
        if (probe->scene.draws_mesh())
            probe->mesh = data.mesh(probe->scene);
        else
            probe->volume = data.volume(probe->scene);
    });
    return PointProbe(std::move(probe));
}

ValueHistogram Session::histogram(int bins) {
    return parts_->run([&] {
        if (bins < 1) fail("histogram: found {} intervals, expected 1 or more", bins);
        const Scene& scene = parts_->pipeline->scene();
        const std::unique_ptr<Field> field = parts_->pipeline->field();
        SceneData& data = parts_->pipeline->data();
        const std::shared_ptr<const void> drawn =
            scene.draws_mesh() ? std::shared_ptr<const void>(data.mesh(scene)) : data.volume(scene);
        if (parts_->counted.lock() != drawn) parts_->counts = field->distribution();
        parts_->counted = drawn;
        return binned(parts_->counts, field->range(), field->whole_numbers(), bins);
    });
}

const FrameStatistics& Session::statistics() const {
    return parts_->statistics;
}

const FrameStatistics& Session::trace_statistics() const {
    return parts_->trace_statistics;
}

std::vector<std::string> Session::take_warnings() {
    const std::lock_guard lock(parts_->keeping);
    return std::exchange(parts_->warnings, {});
}

PointProbe::PointProbe(std::shared_ptr<Parts> parts) : parts_(std::move(parts)) {}

std::optional<SeenPoint> PointProbe::seen(double column, double row) const {
    if (parts_->volume) return seen_point(parts_->scene, parts_->volume->volume, column, row);
    const SceneMesh& mesh = *parts_->mesh;
    std::call_once(parts_->first,
                   [&] { parts_->open_faces.emplace(mesh.mesh, mesh.mesh.open_faces()); });
    return seen_point(parts_->scene, mesh, *parts_->open_faces, column, row);
}

}  // namespace lamina
