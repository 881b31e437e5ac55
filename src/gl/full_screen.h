// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gl/program.h"
#include "gl/vertex_array.h"

namespace lamina::gl {

// Runs the program, whose vertex shader is "gl/full_screen.vert", once for every pixel of the bound
// framebuffer.
void draw_full_screen(const Program& program);
// The same with a given vertex array, so that frames need not make one.
void draw_full_screen(const Program& program, const VertexArray& any);

}  // namespace lamina::gl
