// SPDX-License-Identifier: Apache-2.0
#include "model/document.h"

#include <fmt/format.h>
#include <unistd.h>

#include <fstream>
#include <system_error>
#include <utility>

#include "lamina/error.h"
#include "model/scene_keys.h"

namespace lamina::view {

void save_text(const std::filesystem::path& file, const std::string& text) {
    std::filesystem::path part = file;
    part += fmt::format(".{}.part", getpid());
    std::error_code problem;
    {
        std::ofstream stream(part, std::ios::binary | std::ios::trunc);
        stream << text;
        stream.close();
        if (!stream) problem = std::make_error_code(std::errc::io_error);
    }
    if (!problem) std::filesystem::rename(part, file, problem);
    if (!problem) return;
    std::error_code ignored;
    std::filesystem::remove(part, ignored);
    throw Error(fmt::format("{}: cannot be written: {}", file.string(), problem.message()));
}

namespace {

using Json = nlohmann::ordered_json;

bool same_camera(const Camera& a, const Camera& b) {
    return a.projection == b.projection && a.eye == b.eye && a.center == b.center && a.up == b.up &&
           a.fov_y == b.fov_y && a.height == b.height;
}

// Tells whether both scenes use the same data; other data need a new session.
bool same_data(const Json& a, const Json& b) {
    for (const char* key : {"volume", "scalar", "nan"})
        if (setting_at(a, key) != setting_at(b, key)) return false;
    const Json mesh_a = setting_at(a, "mesh"), mesh_b = setting_at(b, "mesh");
    return mesh_a == mesh_b || (mesh_a.is_object() && mesh_b.is_object());
}

Json without_counted_parts(Json settings) {
    for (const char* key : {"camera", "clip"}) settings.erase(key);
    settings["image"].erase("width");
    settings["image"].erase("height");
    return settings;
}

}  // namespace

void count_changes(const Scene& before, const Scene& after, Revisions& revisions) {
    const Json from = settings_of(before), to = settings_of(after);
    if (!same_data(from, to)) ++revisions.data;
    if (without_counted_parts(from) != without_counted_parts(to) ||
        before.camera.is_automatic() != after.camera.is_automatic() ||
        before.transfer_function.is_automatic() != after.transfer_function.is_automatic())
        ++revisions.settings;
    if (before.transfer_function != after.transfer_function) ++revisions.transfer_function;
    if (before.clip != after.clip) ++revisions.clip;
    if (before.camera.is_given() && after.camera.is_given() &&
        !same_camera(*before.camera, *after.camera))
        ++revisions.camera;
    if (before.width != after.width || before.height != after.height) ++revisions.size;
}

Document::Document() = default;

void Document::open(Scene scene) {
    scene_ = std::move(scene);
    transfer_ = TransferEditor();
    take_transfer_function();
    undo_.clear();
    redo_.clear();
    end_step();
    ++revisions_.data;
    dirty_ = false;
}

// Takes the scene's transfer function into the editor, and shows opacities for its own length.
void Document::take_transfer_function() {
    if (scene_.transfer_function.is_given()) transfer_.take(*scene_.transfer_function);
    for (const DensityPoint& point : transfer_.curves().density)
        if (point.opacity_length > 0) transfer_.set_unit_length(point.opacity_length);
    curves_ = transfer_.curves();
}

void Document::record(const std::string& name, bool camera) {
    redo_.clear();
    dirty_ = true;
    if (name == open_step_ && !undo_.empty()) return;
    undo_.push_back({name, scene_, curves_, camera});
    if (undo_.size() > most_steps) undo_.erase(undo_.begin());
    open_step_ = name;
}

void Document::apply(Scene next) {
    if (is_open()) count_changes(scene_, next, revisions_);
    scene_ = std::move(next);
    if (scene_.transfer_function.is_given()) transfer_.take(*scene_.transfer_function);
    curves_ = transfer_.curves();
}

void Document::set_camera(const Camera& camera) {
    scene_.camera = camera;
    ++revisions_.camera;
    dirty_ = true;
}

void Document::set_transfer_function(const TransferFunction& transfer_function) {
    transfer_.take(transfer_function);
    transfer_edited("transfer function");
}

void Document::transfer_edited(const std::string& name) {
    if (transfer_.curves() == curves_ && scene_.transfer_function.is_given()) return;
    record(name);
    curves_ = transfer_.curves();
    // Points may differ although the function is the same.
    if (scene_.transfer_function == transfer_.function()) return;
    scene_.transfer_function = transfer_.function();
    ++revisions_.transfer_function;
}

void Document::set_clip(const Clip& clip) {
    record("clip");
    scene_.clip = clip;
    ++revisions_.clip;
}

void Document::set_size(int width, int height) {
    if (width == scene_.width && height == scene_.height) return;
    scene_.width = width;
    scene_.height = height;
    ++revisions_.size;
}

void Document::edit(const std::function<void(Scene&)>& change, const std::string& name) {
    Scene next = scene_;
    change(next);
    replace(std::move(next), name);
}

void Document::replace(Scene scene, const std::string& name) {
    record(name, true);
    apply(std::move(scene));
}

void Document::set_setting(const std::string& path, const nlohmann::ordered_json& value) {
    Scene next = with_setting(scene_, path, value);
    record(path, path.starts_with("camera"));
    if (next.color_space != scene_.color_space) {
        transfer_.convert_colors(scene_.color_space, next.color_space);
        if (next.transfer_function.is_given()) next.transfer_function = transfer_.function();
    }
    if (path == "image.width" || path == "image.height") size_follows_window = false;
    apply(std::move(next));
}

void Document::choose_transfer_function() {
    record("automatic transfer function");
    scene_.transfer_function = automatic;
    scene_.given_transfer.reset();
    ++revisions_.settings;
}

void Document::choose_camera() {
    record("automatic camera", true);
    scene_.camera = automatic;
    ++revisions_.settings;
}

void Document::go(std::vector<Step>& from, std::vector<Step>& to) {
    if (from.empty()) return;
    Step step = std::move(from.back());
    from.pop_back();
    to.push_back({step.name, scene_, curves_, step.camera});
    if (!step.camera) step.scene.camera = scene_.camera;
    if (size_follows_window) {
        step.scene.width = scene_.width;
        step.scene.height = scene_.height;
    }
    count_changes(scene_, step.scene, revisions_);
    scene_ = std::move(step.scene);
    transfer_.restore(step.curves);
    curves_ = transfer_.curves();
    dirty_ = true;
    end_step();
}

void Document::undo() {
    go(undo_, redo_);
}

void Document::redo() {
    go(redo_, undo_);
}

void Document::take_chosen(const Scene& chosen) {
    if (scene_.camera.is_automatic()) scene_.camera = chosen.camera;
    if (scene_.transfer_function.is_automatic()) {
        scene_.transfer_function = chosen.transfer_function;
        take_transfer_function();
    }
}

}  // namespace lamina::view
