// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <utility>

namespace lamina::gl {

// Bytes of buffers and textures that this thread's current context holds now: what was asked for,
// without the driver's padding. 0 where none is current.
std::int64_t bytes_allocated();

// Throws Error where a limit on the process's memory (ulimit -v) leaves less than this: Mesa's
// software renderers crash when they get none, and cannot be told to stop before.
void require_memory_left(std::int64_t bytes);

inline constexpr std::int64_t memory_for_context = std::int64_t{1} << 30;
inline constexpr std::int64_t memory_for_drawing = std::int64_t{1} << 28;  // once it is there

// The share of one object in bytes_allocated(), from its making to its end.
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
