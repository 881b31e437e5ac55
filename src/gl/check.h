// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace lamina::gl {

// Throws an Error where OpenGL has reported one since the last call; `where` completes "OpenGL: ...
// while ": "drawing the slabs". Waits for nothing.
void check(std::string_view where);

}  // namespace lamina::gl
