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
    std::vector<std::string> words;  // words after the name

    double number(std::size_t word) const;  // throws Error if the word is no number
    [[noreturn]] void fail(const std::string& expected) const;
};

// Reads a script. Throws Error, also for unknown commands.
std::vector<ScriptCommand> load_script(const std::filesystem::path& file);

// Returns GLFW's number of a key ("A", "7", "Home"). Throws Error for another name.
int key_of(const ScriptCommand& command, const std::string& name);

class Viewer;
class Window;

// Plays a script with simulated input, one command in a frame.
class ScriptPlayer {
  public:
    ScriptPlayer(std::vector<ScriptCommand> commands, Window& window, Viewer& viewer);

    // Does the next action of the script before a frame. Throws Error if a command is impossible or
    // if waiting for the viewer ends with an error.
    void advance(double seconds);
    // Returns the time at which advance() must be called next; empty: after the next event.
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
    std::size_t next_ = 0;                       // index of the next command
    std::deque<std::function<void()>> actions_;  // of the current command
    Waiting waiting_;      // condition of `wait` or of a pause in a drag; null: none
    bool looked_ = false;  // the condition was tested once
    double until_ = 0;     // time (s) of the next test; 0: after the next event
    Measurements measurements_;
};

}  // namespace lamina::view
