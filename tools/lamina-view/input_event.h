// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace lamina::view {

// Something that a user does. Places are in ImGui's units, from the window's upper left corner.
struct InputEvent {
    enum class Kind { pointer, press, release, wheel, key, key_up, drop };
    Kind kind = Kind::pointer;
    double x = 0, y = 0;  // of the pointer; wheel: steps to the right and up
    int button = 0;       // 0 left, 1 right, 2 middle
    int key = 0;          // GLFW's number of a key
    bool shift = false, control = false;
    std::vector<std::filesystem::path> files;  // drop
};

}  // namespace lamina::view
