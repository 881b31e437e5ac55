// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "lamina/scene.h"
#include "lamina/words.h"
#include "model/transfer_editor.h"

namespace lamina::view {

// Counts how often each group of a scene's settings has changed. There is a group for each kind of
// work that lamina::Session repeats after a change (lamina/session.h).
struct Revisions {
    std::uint64_t data = 0;      // the volume or mesh: the session is made anew
    std::uint64_t settings = 0;  // all settings without a count of their own
    std::uint64_t transfer_function = 0, clip = 0, camera = 0, size = 0;
    bool operator==(const Revisions&) const = default;
};

// Writes `text` to a file: to a temporary file beside it, which replaces `file` when it is
// complete. If that fails, throws Error and leaves neither an incomplete nor a temporary file.
void save_text(const std::filesystem::path& file, const std::string& text);

// Increments the count of each group of settings in which the two scenes differ.
void count_changes(const Scene& before, const Scene& after, Revisions& revisions);

// The scene that the user edits, its transfer function as editable curves, and a history of steps
// to undo and redo. A step is one change, or several changes with the same name that follow each
// other without end_step(), such as all changes of a drag. set_camera() and set_size() make no
// step.
class Document {
  public:
    Document();

    const Scene& scene() const { return scene_; }
    const Revisions& revisions() const { return revisions_; }
    bool is_open() const { return revisions_.data > 0; }
    bool dirty() const { return dirty_; }  // changed since it was opened or saved

    void open(Scene scene);  // replaces the scene and its data, and clears the history
    void set_camera(const Camera& camera);
    void set_transfer_function(const TransferFunction& transfer_function);
    void set_clip(const Clip& clip);
    void set_size(int width, int height);
    // Changes anything else of the scene, as a step called `name`.
    void edit(const std::function<void(Scene&)>& change, const std::string& name = "settings");
    void mark_saved() { dirty_ = false; }

    // Sets the value of a key of the scene file, as a step. `path`: as in with_setting()
    // (scene_keys.h). Throws Error, and changes nothing, if the scene would be invalid.
    void set_setting(const std::string& path, const nlohmann::ordered_json& value);
    // Replaces the scene, with the old data or others, as a step.
    void replace(Scene scene, const std::string& name);

    // Returns the editor of the transfer function. After edits, call transfer_edited(): it takes
    // them into the scene, as a step called `name`.
    TransferEditor& transfer() { return transfer_; }
    const TransferEditor& transfer() const { return transfer_; }
    void transfer_edited(const std::string& name);
    // Set the transfer function, or the camera, to `automatic`, so that the session chooses it.
    void choose_transfer_function();
    void choose_camera();

    // Ends the present step: the next change begins a new one, whatever its name.
    void end_step() { open_step_.clear(); }
    bool can_undo() const { return !undo_.empty(); }
    bool can_redo() const { return !redo_.empty(); }
    std::string undo_name() const { return can_undo() ? undo_.back().name : ""; }
    std::string redo_name() const { return can_redo() ? redo_.back().name : ""; }
    void undo();
    void redo();

    // Asks for changes by words (lamina/words.h), as a step: the session makes them
    // (DrawRequest::words) when it chooses the next time. `before`: changes the clip that they add
    // to.
    void adjust(Words words, const std::string& name,
                const std::function<void(Scene&)>& before = {});
    // The changes that the session has not made yet; null if there are none.
    const std::shared_ptr<const Words>& words() const { return words_; }

    // Replaces the scene's transfer function and camera, if they are automatic, by those of
    // `chosen`, the scene as the session resolved it; after adjust(), also lighting and clip.
    // Editing thus starts from the picture that is shown. This is no step and increments no count.
    void take_chosen(const Scene& chosen);

    // True: pictures are as large as the area that shows them; false: as the scene says.
    bool size_follows_window = true;

  private:
    // A step, with the state to which undo() or redo() returns.
    struct Step {
        std::string name;
        Scene scene;  // in undo_: before the step; in redo_: after it
        TransferCurves curves;
        bool with_camera = false;  // the camera of `scene` is restored, too
    };
    static constexpr std::size_t most_steps = 200;

    void edit_scene_transfer_function();
    void begin_step(const std::string& name, bool with_camera = false);
    void set_scene(Scene next);
    void move_step(std::vector<Step>& from, std::vector<Step>& to);

    Scene scene_;
    std::shared_ptr<const Words> words_;
    TransferEditor transfer_;
    TransferCurves curves_;  // of scene_; transfer_ may be ahead until transfer_edited()
    Revisions revisions_;
    std::vector<Step> undo_, redo_;  // the next step to undo, or to redo, is at the back
    std::string open_step_;          // changes of this name join the last step; empty: none do
    bool dirty_ = false;
};

}  // namespace lamina::view
