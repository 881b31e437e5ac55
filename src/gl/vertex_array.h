// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "gl/buffer.h"
#include "gl/handle.h"

namespace lamina::gl {

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
