// SPDX-License-Identifier: Apache-2.0
#include "gl/vertex_array.h"

#include <glad/gl.h>

#include "gl/api.h"
#include "gl/check.h"

namespace lamina::gl {
namespace {

unsigned new_vertex_array() {
    GLuint id = 0;
    api().CreateVertexArrays(1, &id);
    return id;
}

}  // namespace

VertexArray::VertexArray() : handle_(new_vertex_array()) {
    check("making a vertex array");
}

void VertexArray::set_floats(unsigned location, const Buffer& buffer, int components,
                             std::size_t byte_stride, std::size_t byte_offset) {
    api().VertexArrayAttribFormat(id(), location, components, GL_FLOAT, GL_FALSE, 0);
    set_source(location, buffer, byte_stride, byte_offset);
}

void VertexArray::set_integers(unsigned location, const Buffer& buffer, int components,
                               std::size_t byte_stride, std::size_t byte_offset) {
    api().VertexArrayAttribIFormat(id(), location, components, GL_INT, 0);
    set_source(location, buffer, byte_stride, byte_offset);
}

void VertexArray::set_source(unsigned location, const Buffer& buffer, std::size_t byte_stride,
                             std::size_t byte_offset) {
    // Each attribute has the binding point of its own number.
    api().VertexArrayVertexBuffer(id(), location, buffer.id(), static_cast<GLintptr>(byte_offset),
                                  static_cast<GLsizei>(byte_stride));
    api().VertexArrayAttribBinding(id(), location, location);
    api().EnableVertexArrayAttrib(id(), location);
    check("setting a vertex attribute");
}

void VertexArray::set_indices(const Buffer& buffer) {
    api().VertexArrayElementBuffer(id(), buffer.id());
    check("setting the indices");
}

void VertexArray::bind() const {
    api().BindVertexArray(id());
}

}  // namespace lamina::gl
