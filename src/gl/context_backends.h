// SPDX-License-Identifier: Apache-2.0
// The two ways to make a context. Each throws Error with the reason where it fails.
#pragma once

#include <memory>

#include "gl/context.h"

namespace lamina::gl {

enum class EglDevices { hardware, any };

std::unique_ptr<Context> create_osmesa_context();
std::unique_ptr<Context> create_egl_context(EglDevices devices);

// What a library has current in this thread, whoever made it; `context` is null where nothing is.
struct EglBinding {
    unsigned api = 0;  // that eglBindAPI() chose; 0 where EGL is not loaded
    void *display = nullptr, *draw = nullptr, *read = nullptr, *context = nullptr;
};
struct OsmesaBinding {
    void *context = nullptr, *buffer = nullptr;
    unsigned type = 0;  // of the buffer's components
    int width = 0, height = 0;
};

// They return what was current and is so no longer, and make it current again. They load nothing.
EglBinding release_egl();
void restore(const EglBinding& binding);
OsmesaBinding release_osmesa();
void restore(const OsmesaBinding& binding);

}  // namespace lamina::gl
