// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "lamina/scene.h"
#include "model/transfer_editor.h"

namespace lamina::view {

// Counts of changes of each part of a scene, by what a change makes necessary (lamina/session.h).
struct Revisions {
    std::uint64_t data = 0;      // other data; everything is done again
    std::uint64_t settings = 0;  // anything that has no count here
    std::uint64_t transfer_function = 0, clip = 0, camera = 0, size = 0;
    bool operator==(const Revisions&) const = default;
};

// Writes a file that gets its name only when it is complete. If it cannot be written, throws Error
// and leaves no file behind.
void save_text(const std::filesystem::path& file, const std::string& text);

// Increments the counts of the parts in which the scenes differ.
void count_changes(const Scene& before, const Scene& after, Revisions& revisions);

// The scene that is edited, its transfer function as curves, and earlier states. Each change is a
// step that can be undone. Changes of the same name without end_step() between them are one step,
// such as those of a drag. Navigation (set_camera()) is no step.
class Document {
  public:
    Document();

    const Scene& scene() const { return scene_; }
    const Revisions& revisions() const { return revisions_; }
    bool is_open() const { return revisions_.data > 0; }
    bool dirty() const { return dirty_; }  // edited since it was opened or saved

    void open(Scene scene);  // a scene of other data; there is nothing to undo
    void set_camera(const Camera& camera);
    void set_transfer_function(const TransferFunction& transfer_function);
    void set_clip(const Clip& clip);
    void set_size(int width, int height);
    // Makes any other change of the scene; the data stay.
    void edit(const std::function<void(Scene&)>& change, const std::string& name = "settings");
    void mark_saved() { dirty_ = false; }

    // Sets a key of the scene file (scene_keys.h). Throws Error, and changes nothing, if the file
    // would be invalid.
    void set_setting(const std::string& path, const nlohmann::ordered_json& value);
    // Replaces the scene, also by one of other data, as a step.
    void replace(Scene scene, const std::string& name);

    // Returns the transfer function's editor. Its edits take effect with transfer_edited().
    TransferEditor& transfer() { return transfer_; }
    const TransferEditor& transfer() const { return transfer_; }
    void transfer_edited(const std::string& name);
    // Make the transfer function, or the camera, automatic.
    void choose_transfer_function();
    void choose_camera();

    void end_step() { open_step_.clear(); }
    bool can_undo() const { return !undo_.empty(); }
    bool can_redo() const { return !redo_.empty(); }
    std::string undo_name() const { return can_undo() ? undo_.back().name : ""; }
    std::string redo_name() const { return can_redo() ? redo_.back().name : ""; }
    void undo();
    void redo();

    // Takes over what was chosen for the scene's automatic transfer function and camera, so that
    // editing starts from the picture that is shown. This counts as no change.
    void take_chosen(const Scene& chosen);

    // True: pictures have the size of their area in the window; false: the scene's size.
    bool size_follows_window = true;

  private:
    void take_transfer_function();
    struct Step {
        std::string name;
        Scene scene;  // before the step; in redo_, after it
        TransferCurves curves;
        bool camera = false;  // undoing restores the camera, too
    };
    static constexpr std::size_t most_steps = 200;

    void record(const std::string& name, bool camera = false);
    void apply(Scene next);
    void go(std::vector<Step>& from, std::vector<Step>& to);

    Scene scene_;
    TransferEditor transfer_;
    TransferCurves curves_;  // of scene_, before the current edit
    Revisions revisions_;
    std::vector<Step> undo_, redo_;
    std::string open_step_;
    bool dirty_ = false;
};

}  // namespace lamina::view
