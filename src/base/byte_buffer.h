// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string_view>

namespace lamina {

// Bytes that are filled right after they are made: memory for gigabytes is not zeroed before.
class ByteBuffer {
  public:
    ByteBuffer() = default;
    explicit ByteBuffer(std::size_t size)  // throws std::bad_alloc
        : bytes_(std::make_unique_for_overwrite<char[]>(size)), size_(size) {}

    char* data() { return bytes_.get(); }
    std::size_t size() const { return size_; }
    std::string_view text() const { return {bytes_.get(), size_}; }
    std::span<char> span() { return {bytes_.get(), size_}; }
    void shorten(std::size_t size) { size_ = size; }

  private:
    std::unique_ptr<char[]> bytes_;
    std::size_t size_ = 0;
};

}  // namespace lamina
