// SPDX-License-Identifier: Apache-2.0
#include "gl/buffer.h"

#include <glad/gl.h>

#include <cassert>

#include "gl/check.h"

namespace lamina::gl {
namespace {

unsigned new_buffer() {
    GLuint id = 0;
    glCreateBuffers(1, &id);
    return id;
}

}  // namespace

Buffer::Buffer(std::size_t byte_count) : handle_(new_buffer()) {
    assert(byte_count > 0);
    glNamedBufferStorage(id(), static_cast<GLsizeiptr>(byte_count), nullptr,
                         GL_DYNAMIC_STORAGE_BIT);
    check("allocating a buffer");
    bytes_ = AllocatedBytes(static_cast<std::int64_t>(byte_count));
}

void Buffer::write_bytes(std::span<const std::byte> bytes, std::size_t byte_offset) {
    assert(byte_offset + bytes.size() <= byte_count());
    glNamedBufferSubData(id(), static_cast<GLintptr>(byte_offset),
                         static_cast<GLsizeiptr>(bytes.size()), bytes.data());
    check("writing a buffer");
}

void Buffer::bind_uniform(unsigned binding) const {
    glBindBufferBase(GL_UNIFORM_BUFFER, binding, id());
}

void Buffer::bind_storage(unsigned binding) const {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, id());
}

}  // namespace lamina::gl
