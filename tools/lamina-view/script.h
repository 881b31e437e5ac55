// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

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

}  // namespace lamina::view
