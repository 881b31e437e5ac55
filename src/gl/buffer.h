// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <type_traits>

#include "gl/api.h"

namespace lamina::gl {

// GPU memory of a fixed size for vertices, indices or blocks of data. Its contents are undefined
// until written.
class Buffer {
  public:
    Buffer() = default;
    explicit Buffer(std::size_t byte_count);
    // Makes a buffer for a stream of data. It stays mapped, and a draw sees what was written
    // through mapped() before it. The writer must not change data that a draw still reads (see
    // Fence).
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

    // Binds the buffer to block number `binding` of the shaders' uniform or shader storage blocks.
    void bind_uniform(unsigned binding) const;
    void bind_storage(unsigned binding) const;

    // Returns the mapped memory, which is slow to read; null if the buffer is not mapped.
    std::byte* mapped() const { return mapped_; }

    unsigned id() const { return handle_.id(); }
    std::size_t byte_count() const { return static_cast<std::size_t>(bytes_.count()); }

  private:
    void write_bytes(std::span<const std::byte> bytes, std::size_t byte_offset);

    Handle<ObjectKind::buffer> handle_;
    AllocatedBytes bytes_;
    std::byte* mapped_ = nullptr;
};

// The sources of vertex attributes and indices. Without attributes it serves shaders that need only
// gl_VertexID. The buffers must outlive the draws.
class VertexArray {
  public:
    VertexArray();

    // Sets attribute `location` to `components` floats, or 32-bit integers, at `byte_offset` of
    // every `byte_stride` bytes.
    void set_floats(unsigned location, const Buffer& buffer, int components,
                    std::size_t byte_stride, std::size_t byte_offset);
    void set_integers(unsigned location, const Buffer& buffer, int components,
                      std::size_t byte_stride, std::size_t byte_offset);
    void set_indices(const Buffer& buffer);  // 32-bit unsigned

    void bind() const;
    unsigned id() const { return handle_.id(); }

  private:
    void set_source(unsigned location, const Buffer& buffer, std::size_t byte_stride,
                    std::size_t byte_offset);

    Handle<ObjectKind::vertex_array> handle_;
};

}  // namespace lamina::gl
