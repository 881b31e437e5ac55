// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gl/program.h"

namespace lamina::gl {

// Runs the program, whose vertex shader is "gl/full_screen.vert", once for every pixel of the bound
// framebuffer.
void draw_full_screen(const Program& program);

}  // namespace lamina::gl
