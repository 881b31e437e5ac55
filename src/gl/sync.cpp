// SPDX-License-Identifier: Apache-2.0
#include "gl/sync.h"

#include <algorithm>
#include <cassert>

#include <glad/gl.h>
#include "base/error.h"
#include "gl/context.h"
#include "gl/texture.h"

namespace lamina::gl {

Fence::~Fence() {
    if (sync_ != nullptr) api().DeleteSync(static_cast<GLsync>(sync_));
}

void Fence::set() {
    if (sync_ != nullptr) api().DeleteSync(static_cast<GLsync>(sync_));
    sync_ = api().FenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
}

// Dispatches of a GPU take far less than a minute (WorkPace), those of software may take more.
void Fence::wait() {
    if (sync_ == nullptr) return;
    constexpr GLuint64 seconds = 60, nanoseconds = 1'000'000'000;
    const Capabilities& capabilities = current_context()->capabilities();
    GLenum found = GL_TIMEOUT_EXPIRED;
    while (found == GL_TIMEOUT_EXPIRED) {
        found = api().ClientWaitSync(static_cast<GLsync>(sync_), GL_SYNC_FLUSH_COMMANDS_BIT,
                                     seconds * nanoseconds);
        if (found == GL_TIMEOUT_EXPIRED && !capabilities.software)
            fail("OpenGL: the GPU was not done within {} s; is it lost?: {}", seconds,
                 capabilities.renderer);
    }
    if (found == GL_WAIT_FAILED) {
        check("waiting for the GPU");
        fail("OpenGL: waiting for the GPU failed: {}", capabilities.renderer);
    }
    api().DeleteSync(static_cast<GLsync>(sync_));
    sync_ = nullptr;
}

void Fence::end_step() {
    wait();
    set();
    api().Flush();
}

void ReadBack::take(const Buffer& buffer) {
    take(buffer, 0, buffer.byte_count());
}

void ReadBack::take(const Buffer& buffer, std::size_t byte_offset, std::size_t byte_count) {
    assert(byte_offset + byte_count <= buffer.byte_count());
    if (buffer.mapped() != nullptr) {
        taken_ = {buffer.mapped() + byte_offset, byte_count};
    } else {
        reserve(byte_count);
        api().CopyNamedBufferSubData(buffer.id(), copy_.id(), static_cast<GLintptr>(byte_offset), 0,
                                     static_cast<GLsizeiptr>(byte_count));
    }
    end_take();
}

int ReadBack::rows_at_once(std::size_t row_bytes) {
    constexpr std::size_t most_bytes = std::size_t{1} << 27;
    return static_cast<int>(std::max(most_bytes / row_bytes, std::size_t{1}));
}

void ReadBack::take(const Texture& texture) {
    take(texture, 0, texture.height());
}

void ReadBack::take(const Texture& texture, int first_row, int row_count) {
    assert(texture.format() != TextureFormat::rgba16i);
    const std::size_t row_bytes = 4 * sizeof(float) * static_cast<std::size_t>(texture.width());
    reserve(row_bytes * static_cast<std::size_t>(row_count) *
            static_cast<std::size_t>(texture.depth()));
    // The transfer goes in bands of rows, because OpenGL counts its bytes in an int.
    const std::size_t band_bytes = std::size_t{1} << 26;
    const int band_rows = static_cast<int>(std::max(band_bytes / row_bytes, std::size_t{1}));
    api().BindBuffer(GL_PIXEL_PACK_BUFFER, copy_.id());
    std::size_t place = 0;
    for (int z = 0; z < texture.depth(); ++z) {
        for (int y = first_row; y < first_row + row_count; y += band_rows) {
            const int rows = std::min(band_rows, first_row + row_count - y);
            const std::size_t bytes = row_bytes * static_cast<std::size_t>(rows);
            api().GetTextureSubImage(texture.id(), 0, 0, y, z, texture.width(), rows, 1, GL_RGBA,
                                     GL_FLOAT, static_cast<GLsizei>(bytes),
                                     reinterpret_cast<void*>(place));  // a place in the buffer
            place += bytes;
        }
    }
    api().BindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    end_take();
}

void ReadBack::reserve(std::size_t byte_count) {
    fence_.wait();  // for the copy before, which has the memory
    if (copy_.byte_count() < byte_count) copy_ = Buffer::make_host(byte_count);
    taken_ = {copy_.mapped(), byte_count};
}

// The memory is not mapped coherently, so the barrier stands in front of the fence.
void ReadBack::end_take() {
    api().MemoryBarrier(GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT);
    fence_.set();
    api().Flush();
    check("reading back");
}

std::span<const std::byte> ReadBack::finished() {
    fence_.wait();
    return taken_;
}

}  // namespace lamina::gl
