// SPDX-License-Identifier: Apache-2.0
#include "gl/full_screen.h"

#include <glad/gl.h>

#include "gl/api.h"
#include "gl/check.h"

namespace lamina::gl {

void draw_full_screen(const Program& program) {
    draw_full_screen(program, VertexArray());
}

void draw_full_screen(const Program& program, const VertexArray& any) {
    any.bind();
    program.use();
    api().DrawArrays(GL_TRIANGLES, 0, 3);
    check("drawing over the whole target");
}

}  // namespace lamina::gl
