// SPDX-License-Identifier: Apache-2.0
#include "gl/buffer.h"

#include <glad/gl.h>

#include <cassert>

#include "base/error.h"
#include "gl/api.h"
#include "gl/check.h"

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

}  // namespace lamina::gl
