// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace lamina {

// Names what draws. osmesa and egl: OpenGL 4.5 without a window; cpu: the native engine, which
// needs no OpenGL. An automatic choice takes a GPU through EGL if there is one, else the native
// engine.
enum class ContextChoice { osmesa, egl, cpu };

}  // namespace lamina
