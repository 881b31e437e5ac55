// SPDX-License-Identifier: Apache-2.0
#include "gl/fence.h"

#include <glad/gl.h>

namespace lamina::gl {

Fence::~Fence() {
    if (sync_ != nullptr) glDeleteSync(static_cast<GLsync>(sync_));
}

void Fence::set() {
    if (sync_ != nullptr) glDeleteSync(static_cast<GLsync>(sync_));
    sync_ = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
}

void Fence::wait() {
    if (sync_ == nullptr) return;
    constexpr GLuint64 nanoseconds = 1'000'000'000;
    while (glClientWaitSync(static_cast<GLsync>(sync_), GL_SYNC_FLUSH_COMMANDS_BIT, nanoseconds) ==
           GL_TIMEOUT_EXPIRED) {
    }
    glDeleteSync(static_cast<GLsync>(sync_));
    sync_ = nullptr;
}

}  // namespace lamina::gl
