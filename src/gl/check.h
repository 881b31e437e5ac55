// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace lamina::gl {

// Throws Error where OpenGL has reported an error since the last call. `where` completes "OpenGL:
// ... while ", for example "drawing the slabs". Does not wait for the GPU.
void check(std::string_view where);

}  // namespace lamina::gl
