// SPDX-License-Identifier: Apache-2.0
#pragma once

struct GladGLContext;  // of <glad/gl.h>

namespace lamina::gl {

// OpenGL's functions, of the context that is current in this thread: those of OSMesa are not those
// of EGL.
const GladGLContext& api();

}  // namespace lamina::gl
