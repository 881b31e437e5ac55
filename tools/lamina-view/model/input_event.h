// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <glm/vec2.hpp>
#include <string>
#include <vector>

namespace lamina::view {

enum class PointerButton { left, right, middle };

// Keys have GLFW's numbers: letters and digits those of their capital letters in ASCII.
namespace key {
constexpr int escape = 256, enter = 257, tab = 258, right = 262, left = 263, down = 264, up = 265,
              home = 268;
}

// An input of a user.
struct InputEvent {
    enum class Kind { pointer, press, release, wheel, key, character, drop };
    Kind kind = Kind::pointer;
    double seconds = 0;   // when
    glm::dvec2 place{0};  // of the pointer in the window; wheel: steps to the right and up
    PointerButton button = PointerButton::left;
    int key = 0;             // pressed, or repeated
    unsigned character = 0;  // Unicode
    bool shift = false, control = false;
    std::vector<std::filesystem::path> files = {};  // dropped
};

}  // namespace lamina::view
