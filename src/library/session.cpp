// SPDX-License-Identifier: Apache-2.0
#include "lamina/session.h"

#include <utility>

#include "base/error.h"
#include "base/profile.h"
#include "library/point_probe_parts.h"
#include "library/session_parts.h"
#include "scene/half_space.h"
#include "scene/lighting_check.h"

namespace lamina {

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
    half_spaces(clip);  // throws if the clip is wrong
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

const Scene& Session::scene() const {
    return parts_->pipeline->asked();
}

const Scene& Session::chosen_scene() const {
    return parts_->pipeline->scene();
}

const Scene& Session::resolved_scene() {
    const Scene* resolved = nullptr;
    parts_->run([&] { resolved = &parts_->pipeline->resolved_scene(); });
    return *resolved;
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
    PlanSummary summary;
    parts_->run([&] {
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
    });
    return summary;
}

std::string Session::explanation() {
    std::string text;
    parts_->run([&] { text = parts_->pipeline->explanation(); });
    return text;
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
    const PreciseImage* truth = nullptr;
    parts_->run(
        [&] {
            truth = &parts_->pipeline->trace(tile_done).image;
            parts_->trace_statistics = parts_->pipeline->trace_statistics();
            parts_->pipeline->warn_of(to_float(*truth));
        },
        std::move(stop), progress);
    parts_->trace_statistics.draw_ms = 1e3 * watch.seconds();
    return *truth;
}

Grid::Bounds Session::bounds() {
    Grid::Bounds bounds;
    parts_->run([&] {
        const Scene& scene = parts_->pipeline->scene();
        if (scene.draws_mesh()) {
            const auto& [min, max] = parts_->pipeline->data().mesh(scene)->mesh.bounds();
            bounds = {min, max};
        } else {
            bounds = parts_->pipeline->data().volume(scene)->volume.grid().bounds();
        }
    });
    return bounds;
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
    ValueHistogram found;
    parts_->run([&] { found = parts_->histogram(bins); });
    return found;
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

}  // namespace lamina
