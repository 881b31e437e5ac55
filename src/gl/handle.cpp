// SPDX-License-Identifier: Apache-2.0
#include "gl/handle.h"

#include <glad/gl.h>

#include "gl/api.h"

namespace lamina::gl {

void delete_object(ObjectKind kind, unsigned id) {
    switch (kind) {
        case ObjectKind::buffer:
            api().DeleteBuffers(1, &id);
            break;
        case ObjectKind::texture:
            api().DeleteTextures(1, &id);
            break;
        case ObjectKind::vertex_array:
            api().DeleteVertexArrays(1, &id);
            break;
        case ObjectKind::framebuffer:
            api().DeleteFramebuffers(1, &id);
            break;
        case ObjectKind::query:
            api().DeleteQueries(1, &id);
            break;
        case ObjectKind::shader:
            api().DeleteShader(id);
            break;
        case ObjectKind::program:
            api().DeleteProgram(id);
            break;
    }
}

}  // namespace lamina::gl
