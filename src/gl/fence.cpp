// SPDX-License-Identifier: Apache-2.0
#include "gl/fence.h"

#include <glad/gl.h>

#include "gl/api.h"

namespace lamina::gl {

Fence::~Fence() {
    if (sync_ != nullptr) api().DeleteSync(static_cast<GLsync>(sync_));
}

void Fence::set() {
    if (sync_ != nullptr) api().DeleteSync(static_cast<GLsync>(sync_));
    sync_ = api().FenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
}

void Fence::wait() {
    if (sync_ == nullptr) return;
    constexpr GLuint64 nanoseconds = 1'000'000'000;
    while (api().ClientWaitSync(static_cast<GLsync>(sync_), GL_SYNC_FLUSH_COMMANDS_BIT,
                                nanoseconds) == GL_TIMEOUT_EXPIRED) {
    }
    api().DeleteSync(static_cast<GLsync>(sync_));
    sync_ = nullptr;
}

}  // namespace lamina::gl
