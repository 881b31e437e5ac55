// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "measurements.h"
#include "model/navigator.h"

namespace lamina::view {

// A line of a script (docs/viewer.md, "Scripts").
struct ScriptCommand {
    std::string where;  // "FILE:LINE"
    std::string name;
    std::vector<std::string> words;  // what follows

    double number(std::size_t word) const;  // throws Error if it is none
    [[noreturn]] void fail(const std::string& expected) const;
};

// Reads a script. Throws Error, also for unknown commands.
std::vector<ScriptCommand> load_script(const std::filesystem::path& file);

// Returns GLFW's number of a key by its name ("A", "7", "Home"); throws Error.
int key_of(const ScriptCommand& command, const std::string& name);

class Viewer;
class Window;

// Plays a script, one command a frame, as if a user did it.
class ScriptPlayer {
  public:
    ScriptPlayer(std::vector<ScriptCommand> commands, Window& window, Viewer& viewer);

    // Carries out commands before a frame. Throws Error if a command cannot be carried out, or
    // something went wrong in the window.
    void advance(double seconds);
    // When it has to go on; nothing: when something happens.
    std::optional<double> next(double seconds) const;
    bool done() const { return next_ == commands_.size() && actions_.empty() && !waiting_; }
    Measurements& measurements() { return measurements_; }

  private:
    using Waiting = std::function<bool(double)>;
    void begin(const ScriptCommand& command, double seconds);
    void begin_pointer(const ScriptCommand& command);
    void begin_drag(const ScriptCommand& command);
    void begin_wait(const ScriptCommand& command, double seconds);
    void press(const ScriptCommand& command, std::size_t from, PointerButton button, bool down);
    void then(std::function<void()> action) { actions_.push_back(std::move(action)); }
    void measure(const ScriptCommand& command);
    void set(const ScriptCommand& command);

    std::vector<ScriptCommand> commands_;
    Window& window_;
    Viewer& viewer_;
    std::size_t next_ = 0;
    std::deque<std::function<void()>> actions_;  // of the command that is being done
    Waiting waiting_;
    bool looked_ = false;  // whether what is waited for is there already
    double until_ = 0;     // of a wait for a time
    Measurements measurements_;
};

}  // namespace lamina::view
