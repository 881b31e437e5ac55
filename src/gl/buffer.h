// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <type_traits>

#include "gl/handle.h"
#include "gl/memory.h"

namespace lamina::gl {

// GPU memory of a fixed size for vertices, indices or blocks of data. Contents are undefined until
// written.
class Buffer {
  public:
    Buffer() = default;
    explicit Buffer(std::size_t byte_count);
    // For a stream of data: mapped from now on, and what is written through mapped() is seen by the
    // draws that follow. The writer takes care not to change what a draw still reads (Fence).
    static Buffer make_mapped(std::size_t byte_count);

    template <typename T, std::size_t extent>
    explicit Buffer(std::span<T, extent> elements) : Buffer(elements.size_bytes()) {
        write(elements);
    }

    // Replaces the bytes from `byte_offset` on by `elements`, which must fit.
    template <typename T, std::size_t extent>
    void write(std::span<T, extent> elements, std::size_t byte_offset = 0) {
        static_assert(std::is_trivially_copyable_v<T>);
        write_bytes(std::as_bytes(elements), byte_offset);
    }

    // As block number `binding` of the shaders' uniform or buffer (shader storage) blocks.
    void bind_uniform(unsigned binding) const;
    void bind_storage(unsigned binding) const;

    std::byte* mapped() const { return mapped_; }  // null where it is not; slow to read

    unsigned id() const { return handle_.id(); }
    std::size_t byte_count() const { return static_cast<std::size_t>(bytes_.count()); }

  private:
    void write_bytes(std::span<const std::byte> bytes, std::size_t byte_offset);

    Handle<ObjectKind::buffer> handle_;
    AllocatedBytes bytes_;
    std::byte* mapped_ = nullptr;
};

}  // namespace lamina::gl
