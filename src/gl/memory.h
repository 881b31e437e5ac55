// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <utility>

namespace lamina::gl {

// Bytes of buffers and textures that this thread's current context holds now: what was asked for,
// without the driver's padding. 0 where none is current.
std::int64_t bytes_allocated();

// Throws Error where a limit on the process's memory (ulimit -v) leaves less than `bytes`. Mesa's
// software renderers crash when they run out of memory and cannot be stopped earlier.
void require_memory_left(std::int64_t bytes);

inline constexpr std::int64_t memory_for_context = std::int64_t{1} << 30;
// Needed once the context exists.
inline constexpr std::int64_t memory_for_drawing = std::int64_t{1} << 28;

// The contribution of one object to bytes_allocated() during its lifetime.
class AllocatedBytes {
  public:
    AllocatedBytes() = default;
    explicit AllocatedBytes(std::int64_t count);
    AllocatedBytes(AllocatedBytes&& other) noexcept : count_(std::exchange(other.count_, 0)) {}
    AllocatedBytes& operator=(AllocatedBytes&& other) noexcept {
        std::swap(count_, other.count_);
        return *this;
    }
    ~AllocatedBytes();

    std::int64_t count() const { return count_; }

  private:
    std::int64_t count_ = 0;
};

}  // namespace lamina::gl
