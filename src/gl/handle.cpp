// SPDX-License-Identifier: Apache-2.0
#include "gl/handle.h"

#include <glad/gl.h>

namespace lamina::gl {

void delete_object(ObjectKind kind, unsigned id) {
    switch (kind) {
        case ObjectKind::buffer:
            glDeleteBuffers(1, &id);
            break;
        case ObjectKind::texture:
            glDeleteTextures(1, &id);
            break;
        case ObjectKind::vertex_array:
            glDeleteVertexArrays(1, &id);
            break;
        case ObjectKind::framebuffer:
            glDeleteFramebuffers(1, &id);
            break;
        case ObjectKind::query:
            glDeleteQueries(1, &id);
            break;
        case ObjectKind::shader:
            glDeleteShader(id);
            break;
        case ObjectKind::program:
            glDeleteProgram(id);
            break;
    }
}

}  // namespace lamina::gl
