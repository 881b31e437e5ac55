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
    std::filesystem::path temporary = file;
    temporary += fmt::format(".{}.part", getpid());
    std::error_code problem;
    {
        std::ofstream stream(temporary, std::ios::binary | std::ios::trunc);
        stream << text;
        stream.close();
        if (!stream) problem = std::make_error_code(std::errc::io_error);
    }
    if (!problem) std::filesystem::rename(temporary, file, problem);
    if (!problem) return;
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    throw Error(fmt::format("{}: cannot be written: {}", file.string(), problem.message()));
}

namespace {

using Json = nlohmann::ordered_json;

bool same_camera(const Camera& a, const Camera& b) {
    return a.projection == b.projection && a.eye == b.eye && a.center == b.center && a.up == b.up &&
           a.fov_y == b.fov_y && a.height == b.height;
}

// Returns true if the mesh is made from the volume: its keys then name no file.
bool is_made(const Json& mesh) {
    return mesh.is_object() && !mesh.contains("path");
}

// Returns true if both scenes draw the same data, so that the session can be kept: if settings of a
// mesh made from the volume change, the session makes it again. `a`, `b`: from settings_of().
bool same_data(const Json& a, const Json& b) {
    for (const char* key : {"volume", "scalar", "nan"})
        if (setting_at(a, key) != setting_at(b, key)) return false;
    const Json mesh_a = setting_at(a, "mesh"), mesh_b = setting_at(b, "mesh");
    return mesh_a == mesh_b || (is_made(mesh_a) && is_made(mesh_b));
}

// Removes the settings that have counts of their own in Revisions.
Json without_counted_settings(Json settings) {
    for (const char* key : {"camera", "clip"}) settings.erase(key);
    settings["image"].erase("width");
    settings["image"].erase("height");
    return settings;
}

}  // namespace

void count_changes(const Scene& before, const Scene& after, Revisions& revisions) {
    const Json from = settings_of(before), to = settings_of(after);
    if (!same_data(from, to)) ++revisions.data;
    if (without_counted_settings(from) != without_counted_settings(to) ||
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
    edit_scene_transfer_function();
    undo_.clear();
    redo_.clear();
    end_step();
    ++revisions_.data;
    dirty_ = false;
}

// Gives the scene's transfer function to the editor. If its points have opacities, the editor shows
// opacities for the length to which these refer.
void Document::edit_scene_transfer_function() {
    if (scene_.transfer_function.is_given()) transfer_.take(*scene_.transfer_function);
    for (const DensityPoint& point : transfer_.curves().density)
        if (point.opacity_length > 0) transfer_.set_unit_length(point.opacity_length);
    curves_ = transfer_.curves();
}

// Saves the present state as the one before a step, unless the change joins the open step.
void Document::begin_step(const std::string& name, bool with_camera) {
    redo_.clear();
    dirty_ = true;
    if (name == open_step_ && !undo_.empty()) return;
    undo_.push_back({name, scene_, curves_, with_camera});
    if (undo_.size() > most_steps) undo_.erase(undo_.begin());
    open_step_ = name;
}

// Replaces the scene, counts its changes, and gives its transfer function to the editor.
void Document::set_scene(Scene next) {
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
    begin_step(name);
    curves_ = transfer_.curves();
    // Different curves may be one function, for example with one more point on a line.
    if (scene_.transfer_function == transfer_.function()) return;
    scene_.transfer_function = transfer_.function();
    ++revisions_.transfer_function;
}

void Document::set_clip(const Clip& clip) {
    begin_step("clip");
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
    begin_step(name, true);
    set_scene(std::move(scene));
}

void Document::set_setting(const std::string& path, const nlohmann::ordered_json& value) {
    Scene next = with_setting(scene_, path, value);
    begin_step(path, path.starts_with("camera"));
    if (next.color_space != scene_.color_space) {
        transfer_.convert_colors(scene_.color_space, next.color_space);
        if (next.transfer_function.is_given()) next.transfer_function = transfer_.function();
    }
    if (path == "image.width" || path == "image.height") size_follows_window = false;
    set_scene(std::move(next));
}

void Document::choose_transfer_function() {
    begin_step("automatic transfer function");
    scene_.transfer_function = automatic;
    scene_.given_transfer.reset();
    ++revisions_.settings;
}

void Document::choose_camera() {
    begin_step("automatic camera", true);
    scene_.camera = automatic;
    ++revisions_.settings;
}

// Undoes or redoes the step at the back of `from`: restores its state, and moves the step with the
// present state to `to`.
void Document::move_step(std::vector<Step>& from, std::vector<Step>& to) {
    if (from.empty()) return;
    words_.reset();
    Step step = std::move(from.back());
    from.pop_back();
    to.push_back({step.name, scene_, curves_, step.with_camera});
    if (!step.with_camera) step.scene.camera = scene_.camera;
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
    move_step(undo_, redo_);
}

void Document::redo() {
    move_step(redo_, undo_);
}

void Document::adjust(Words words, const std::string& name,
                      const std::function<void(Scene&)>& before) {
    begin_step(name, true);
    end_step();
    if (before) {
        before(scene_);
        ++revisions_.clip;
    }
    words_ = std::make_shared<const Words>(std::move(words));
    ++revisions_.settings;
}

void Document::take_chosen(const Scene& chosen) {
    const bool adjusted = words_ != nullptr;
    words_.reset();
    if (adjusted) {
        scene_.lighting = chosen.lighting;
        scene_.clip = chosen.clip;
    }
    if (adjusted || scene_.camera.is_automatic()) scene_.camera = chosen.camera;
    if (adjusted || scene_.transfer_function.is_automatic()) {
        scene_.transfer_function = chosen.transfer_function;
        edit_scene_transfer_function();
    }
}

}  // namespace lamina::view
