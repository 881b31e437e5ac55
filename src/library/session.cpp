// SPDX-License-Identifier: Apache-2.0
#include "lamina/session.h"

#include <utility>

#include "base/error.h"
#include "base/stopwatch.h"
#include "choice/choose.h"
#include "library/point_probe_parts.h"
#include "library/session_parts.h"
#include "scene/half_space.h"
#include "scene/lighting_check.h"

namespace lamina {
Session::Session(Scene scene, SessionOptions options)
    : parts_(std::make_unique<Parts>(std::move(scene), options)) {
    parts_->run(
        [&] {
            parts_->scene = parts_->chosen();
            if (parts_->scene.draws_mesh())
                parts_->mesh_data();
            else
                parts_->volume_data();
        },
        options.stop);
}

Session::Session(Scene scene, Volume volume, SessionOptions options)
    : parts_(std::make_unique<Parts>(std::move(scene), options)) {
    parts_->run(
        [&] {
            parts_->volume = std::make_shared<const VolumeData>(std::move(volume));
            parts_->scene = parts_->chosen();
        },
        options.stop);
}

Session::Session(Scene scene, MeshData mesh, SessionOptions options)
    : parts_(std::make_unique<Parts>(std::move(scene), options)) {
    parts_->mesh_given = true;
    parts_->run(
        [&] {
            parts_->mesh =
                std::make_shared<const SceneMesh>(scene_mesh(parts_->scene, std::move(mesh)));
            parts_->scene = parts_->chosen();
        },
        options.stop);
}

Session::~Session() = default;
Session::Session(Session&& other) noexcept = default;
Session& Session::operator=(Session&& other) noexcept = default;

void Session::set_camera(const Camera& camera) {
    check_view(camera, parts_->scene.width, parts_->scene.height);
    parts_->scene.camera = parts_->asked.camera = camera;
    parts_->asked.automatic_camera = false;
    if (parts_->drawn) parts_->drawn->set_camera(camera);
}

void Session::set_size(int width, int height) {
    check_view(parts_->scene.camera, width, height);
    parts_->scene.width = parts_->asked.width = width;
    parts_->scene.height = parts_->asked.height = height;
    if (parts_->drawn) parts_->drawn->set_size(width, height);
}

void Session::set_transfer_function(const TransferFunction& transfer_function) {
    Scene scene = parts_->scene;
    scene.transfer_function = parts_->asked.transfer_function = transfer_function;
    parts_->asked.automatic_transfer_function = false;
    parts_->run([&] {
        parts_->take_scene(std::move(scene));
        if (parts_->drawn) parts_->drawn->set_transfer_function(transfer_function);
    });
}

void Session::set_clip(const Clip& clip) {
    half_spaces(clip);  // checks it
    parts_->scene.clip = parts_->asked.clip = clip;
    if (parts_->drawn) parts_->run([&] { parts_->drawn->set_clip(clip); });
}

void Session::set_scene(Scene scene) {
    check_view(scene.camera, scene.width, scene.height);
    check_lighting(scene);
    parts_->run([&] {
        parts_->asked = std::move(scene);
        parts_->take_scene(parts_->chosen());
        if (parts_->drawn) parts_->drawn->set_scene(parts_->scene);
    });
}

void Session::choose_again() {
    set_scene(parts_->asked);
}

const Scene& Session::scene() const {
    return parts_->asked;
}

const Scene& Session::chosen_scene() const {
    return parts_->scene;
}

const Scene& Session::resolved_scene() {
    if (parts_->scene.method == Method::trace) return parts_->scene;
    const Scene* resolved = nullptr;
    parts_->run_drawing([&] { resolved = &parts_->renderer().resolved_scene(); });
    return *resolved;
}

void Session::save_resolved_scene(const std::filesystem::path& file) {
    const Scene& resolved = resolved_scene();
    if (!resolved.has_volume() && !resolved.has_mesh()) {
        fail("{}: the scene names no data; expected volume_file or mesh_file to say where they are",
             file.string());
    }
    save_scene(resolved, file);
}

PlanSummary Session::plan() {
    PlanSummary summary;
    parts_->run_drawing([&] {
        const Plan& plan = parts_->renderer().plan();
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
    parts_->run_drawing(
        [&] { text = chosen_text(parts_->scene) + parts_->renderer().explanation(); });
    return text;
}

const Image& Session::draw(std::stop_token stop, const ProgressCallback& progress) {
    draw(parts_->picture, std::move(stop), progress);
    return parts_->picture;
}

void Session::draw(Image& picture, std::stop_token stop, const ProgressCallback& progress) {
    Stopwatch watch;
    if (parts_->scene.method == Method::trace) {
        picture = to_float(trace(std::move(stop), progress));
        parts_->statistics = parts_->trace_statistics;
    } else {
        parts_->run_drawing([&] { parts_->draw(picture); }, std::move(stop), progress);
    }
    parts_->statistics.draw_ms = 1e3 * watch.seconds();
}

const PreciseImage& Session::trace(std::stop_token stop, const ProgressCallback& progress,
                                   const TileCallback& tile_done) {
    Stopwatch watch;
    parts_->run([&] { parts_->trace(tile_done); }, std::move(stop), progress);
    parts_->trace_statistics.draw_ms = 1e3 * watch.seconds();
    return parts_->truth;
}

Grid::Bounds Session::bounds() {
    Grid::Bounds bounds;
    parts_->run([&] {
        if (parts_->scene.draws_mesh()) {
            const auto& [min, max] = parts_->mesh_data().mesh.bounds();
            bounds = {min, max};
        } else {
            bounds = parts_->volume_data().volume.grid().bounds();
        }
    });
    return bounds;
}

PointProbe Session::probe() {
    auto probe = std::make_shared<PointProbe::Parts>();
    parts_->run([&] {
        probe->scene = parts_->scene;
        if (parts_->scene.draws_mesh()) {
            parts_->mesh_data();
            probe->mesh = parts_->mesh;
        } else {
            parts_->volume_data();
            probe->volume = parts_->volume;
        }
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
