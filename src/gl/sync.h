// SPDX-License-Identifier: Apache-2.0
// How the host keeps in step with OpenGL, which works on its own.
#pragma once

#include <cstddef>
#include <span>
#include <utility>

#include "gl/api.h"

namespace lamina::gl {

class Texture;

// A point in the stream of OpenGL commands that the program can wait for.
class Fence {
  public:
    Fence() = default;
    ~Fence();
    Fence(const Fence&) = delete;
    Fence& operator=(const Fence&) = delete;
    Fence(Fence&& other) noexcept : sync_(std::exchange(other.sync_, nullptr)) {}
    Fence& operator=(Fence&& other) noexcept {
        std::swap(sync_, other.sync_);
        return *this;
    }

    void set();  // places the fence at the current point
    // Waits until all commands before the fence are complete; returns at once if it was not set.
    // Throws Error if that fails, or if a GPU is not done within a minute.
    void wait();
    // Ends a step of a frame: waits for the fence, which ended the step before, and places it here.
    // So OpenGL has one step to work on while the next one is prepared, and at most two to end.
    void end_step();

  private:
    void* sync_ = nullptr;
};

// Brings pictures and counters to the host: OpenGL copies them into memory of the host that stays
// mapped, and the host waits for a fence behind the copy only when it needs them.
class ReadBack {
  public:
    // Begins to copy a buffer, as the commands so far leave it, and does not wait. A buffer of
    // Buffer::make_readable() is not copied if it is mapped, so that no command must write it until
    // it was looked at.
    void take(const Buffer& buffer);
    void take(const Buffer& buffer, std::size_t byte_offset, std::size_t byte_count);
    // Begins to copy all texels as RGBA floats, x fastest, then y, then z; row 0 is the bottom one,
    // as in OpenGL. The format must not be rgba16i. Absent channels are 0, absent alpha is 1.
    void take(const Texture& texture);
    void take(const Texture& texture, int first_row, int row_count);  // these rows alone
    // Returns how many rows of a picture to take at once: memory that is mapped is kept from other
    // programs, so that of large pictures 128 MiB must do.
    static int rows_at_once(std::size_t row_bytes);

    // Waits for the last take() and returns what it copied, which stays until the next take().
    template <typename T>
    std::span<const T> values() {
        const std::span<const std::byte> bytes = finished();
        return {reinterpret_cast<const T*>(bytes.data()), bytes.size() / sizeof(T)};
    }

  private:
    void reserve(std::size_t byte_count);
    void end_take();
    std::span<const std::byte> finished();

    Buffer copy_;
    std::span<const std::byte> taken_;
    Fence fence_;
};

}  // namespace lamina::gl
