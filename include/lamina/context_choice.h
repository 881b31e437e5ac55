// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace lamina {

// What draws. automatic: a GPU through EGL where there is one, else the native engine; osmesa and
// egl: OpenGL 4.5 without a window; cpu: the native engine, which needs no OpenGL.
enum class ContextChoice { automatic, osmesa, egl, cpu };

}  // namespace lamina
