// SPDX-License-Identifier: Apache-2.0
#include "gl/buffer.h"

#include <cassert>

#include <glad/gl.h>
#include "base/error.h"
#include "gl/api.h"

namespace lamina::gl {

namespace {

unsigned new_buffer() {
    GLuint id = 0;
    api().CreateBuffers(1, &id);
    return id;
}

}  // namespace

Buffer::Buffer(std::size_t byte_count) : handle_(new_buffer()) {
    assert(byte_count > 0);
    require_memory_left(static_cast<std::int64_t>(byte_count) + memory_for_drawing);
    api().NamedBufferStorage(id(), static_cast<GLsizeiptr>(byte_count), nullptr,
                             GL_DYNAMIC_STORAGE_BIT);
    check("allocating a buffer");
    bytes_ = AllocatedBytes(static_cast<std::int64_t>(byte_count));
}

Buffer Buffer::make_mapped(std::size_t byte_count) {
    assert(byte_count > 0);
    constexpr GLbitfield access = GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
    require_memory_left(static_cast<std::int64_t>(byte_count) + memory_for_drawing);
    Buffer buffer;
    buffer.handle_ = Handle<ObjectKind::buffer>(new_buffer());
    const auto bytes = static_cast<GLsizeiptr>(byte_count);
    api().NamedBufferStorage(buffer.id(), bytes, nullptr, access);
    check("allocating a buffer");
    buffer.bytes_ = AllocatedBytes(static_cast<std::int64_t>(byte_count));
    buffer.mapped_ =
        static_cast<std::byte*>(api().MapNamedBufferRange(buffer.id(), 0, bytes, access));
    check("mapping a buffer");
    if (buffer.mapped_ == nullptr) fail("mapping a buffer of {} bytes failed", byte_count);
    return buffer;
}

void Buffer::write_bytes(std::span<const std::byte> bytes, std::size_t byte_offset) {
    assert(byte_offset + bytes.size() <= byte_count());
    api().NamedBufferSubData(id(), static_cast<GLintptr>(byte_offset),
                             static_cast<GLsizeiptr>(bytes.size()), bytes.data());
    check("writing a buffer");
}

void Buffer::bind_uniform(unsigned binding) const {
    api().BindBufferBase(GL_UNIFORM_BUFFER, binding, id());
}

void Buffer::bind_storage(unsigned binding) const {
    api().BindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, id());
}

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
