// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <utility>

namespace lamina::gl {

// Bytes of buffers and textures that this process holds now: what was asked for, without the
// driver's padding.
std::int64_t bytes_allocated();

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
