// SPDX-License-Identifier: Apache-2.0
#include "gl/api.h"

#include <dlfcn.h>
#include <glad/gl.h>
#include <sys/resource.h>
#include <unistd.h>
#include <algorithm>
#include <array>
#include <cassert>
#include <fstream>

#include "base/error.h"
#include "gl/context.h"

namespace lamina::gl {

namespace {

std::string name_of(GLenum error) {
    static constexpr const char* names[] = {"GL_INVALID_ENUM",
                                            "GL_INVALID_VALUE",
                                            "GL_INVALID_OPERATION",
                                            "GL_STACK_OVERFLOW",
                                            "GL_STACK_UNDERFLOW",
                                            "GL_OUT_OF_MEMORY",
                                            "GL_INVALID_FRAMEBUFFER_OPERATION",
                                            "GL_CONTEXT_LOST"};
    const std::size_t index = error - GL_INVALID_ENUM;
    return index < std::size(names) ? names[index] : "unknown error";
}

// Returns the driver's own message about the oldest error, and empties its log.
std::string take_debug_message() {
    std::string first;
    std::array<char, 1024> text;
    GLsizei length = 0;
    while (api().GetDebugMessageLog(1, static_cast<GLsizei>(text.size()), nullptr, nullptr, nullptr,
                                    nullptr, &length, text.data()) == 1) {
        if (first.empty())
            first.assign(text.data(), static_cast<std::size_t>(std::max(length - 1, 0)));
    }
    return one_line(first);
}

}  // namespace

void check(std::string_view where) {
    const GLenum first = api().GetError();
    if (first == GL_NO_ERROR) return;
    // Clears the error flags; the count is limited because a lost context reports errors for ever.
    for (int i = 0; i < 32 && api().GetError() != GL_NO_ERROR; ++i) {
    }
    const std::string message = take_debug_message();
    fail("OpenGL: {} while {}{}{}", name_of(first), where, message.empty() ? "" : ": ", message);
}

int integer(unsigned name) {
    GLint value = 0;
    api().GetIntegerv(name, &value);
    return value;
}

unsigned new_object(ObjectKind kind) {
    static constexpr std::array makers{&GladGLContext::CreateBuffers,
                                       &GladGLContext::CreateVertexArrays,
                                       &GladGLContext::CreateFramebuffers};
    GLuint id = 0;
    (api().*makers[static_cast<std::size_t>(kind)])(1, &id);
    return id;
}

void delete_object(ObjectKind kind, unsigned id) {
    if (kind == ObjectKind::shader) return api().DeleteShader(id);
    if (kind == ObjectKind::program) return api().DeleteProgram(id);
    static constexpr std::array deleters{
        &GladGLContext::DeleteBuffers, &GladGLContext::DeleteVertexArrays,
        &GladGLContext::DeleteFramebuffers, &GladGLContext::DeleteTextures,
        &GladGLContext::DeleteQueries};
    (api().*deleters[static_cast<std::size_t>(kind)])(1, &id);
}

std::int64_t bytes_allocated() {
    Context* const context = current_context();
    return context != nullptr ? context->counts().bytes_allocated : 0;
}

void require_memory_left(std::int64_t bytes) {
    rlimit limit{};
    if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return;
    std::int64_t pages = 0;
    if (!(std::ifstream("/proc/self/statm") >> pages)) return;
    const std::int64_t left = static_cast<std::int64_t>(limit.rlim_cur) - pages * getpagesize();
    if (left >= bytes) return;
    constexpr std::int64_t mebibyte = 1 << 20;
    fail(
        "OpenGL: the limit on this process's memory (ulimit -v) leaves {} MiB, expected {}: raise "
        "it, or do without OpenGL: --context cpu",
        left / mebibyte, bytes / mebibyte);
}

AllocatedBytes::AllocatedBytes(std::int64_t count) : count_(count) {
    current_context()->counts().bytes_allocated += count_;
}

AllocatedBytes::~AllocatedBytes() {
    if (count_ != 0) current_context()->counts().bytes_allocated -= count_;
}

SharedLibrary::SharedLibrary(std::initializer_list<const char*> names) {
    std::string reasons;
    for (const char* name : names) {
        handle_ = dlopen(name, RTLD_NOW | RTLD_LOCAL);
        if (handle_) {
            name_ = name;
            return;
        }
        const char* reason = dlerror();  // begins with the library's name
        reasons += (reasons.empty() ? "" : "; ") + std::string(reason ? reason : name);
    }
    fail("{}", one_line(reasons));
}

bool SharedLibrary::is_loaded(const char* name) {
    void* const handle = dlopen(name, RTLD_NOW | RTLD_NOLOAD);
    if (handle != nullptr) dlclose(handle);
    return handle != nullptr;
}

AnyFunction SharedLibrary::function(const char* name) const {
    void* const address = dlsym(handle_, name);
    if (!address) fail("{} has no function {}", name_, name);
    return {address};
}

Buffer::Buffer(std::size_t byte_count) : Buffer(byte_count, GL_DYNAMIC_STORAGE_BIT) {}

Buffer::Buffer(std::size_t byte_count, unsigned storage_flags)
    : handle_(new_object(ObjectKind::buffer)) {
    assert(byte_count > 0);
    require_memory_left(static_cast<std::int64_t>(byte_count) + memory_for_drawing);
    api().NamedBufferStorage(id(), static_cast<GLsizeiptr>(byte_count), nullptr, storage_flags);
    check("allocating a buffer");
    bytes_ = AllocatedBytes(static_cast<std::int64_t>(byte_count));
}

Buffer Buffer::make_mapped(std::size_t byte_count) {
    constexpr GLbitfield access = GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
    return make_mapped(byte_count, access, 0);
}

Buffer Buffer::make_host(std::size_t byte_count) {
    return make_mapped(byte_count, GL_MAP_READ_BIT | GL_MAP_PERSISTENT_BIT, GL_CLIENT_STORAGE_BIT);
}

Buffer Buffer::make_readable(std::size_t byte_count) {
    if (!current_context()->capabilities().software) return Buffer(byte_count);
    return make_mapped(byte_count, GL_MAP_READ_BIT | GL_MAP_PERSISTENT_BIT, 0);
}

Buffer Buffer::make_mapped(std::size_t byte_count, unsigned access, unsigned storage_flags) {
    Buffer buffer(byte_count, access | storage_flags);
    buffer.mapped_ = static_cast<std::byte*>(
        api().MapNamedBufferRange(buffer.id(), 0, static_cast<GLsizeiptr>(byte_count), access));
    check("mapping a buffer");
    if (buffer.mapped_ == nullptr) fail("mapping a buffer of {} bytes failed", byte_count);
    return buffer;
}

void Buffer::write_bytes(std::span<const std::byte> bytes, std::size_t byte_offset) {
    assert(byte_offset + bytes.size() <= byte_count());
    current_context()->counts().bytes_uploaded += static_cast<std::int64_t>(bytes.size());
    api().NamedBufferSubData(id(), static_cast<GLintptr>(byte_offset),
                             static_cast<GLsizeiptr>(bytes.size()), bytes.data());
    check("writing a buffer");
}

void Buffer::read_bytes(std::span<std::byte> bytes, std::size_t byte_offset) const {
    assert(byte_offset + bytes.size() <= byte_count());
    api().GetNamedBufferSubData(id(), static_cast<GLintptr>(byte_offset),
                                static_cast<GLsizeiptr>(bytes.size()), bytes.data());
    check("reading a buffer");
}

void Buffer::clear() {
    api().ClearNamedBufferData(id(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
}

void Buffer::bind_storage(unsigned binding) const {
    api().BindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, id());
}

void Buffer::bind_storage(unsigned binding, std::size_t byte_offset, std::size_t byte_count) const {
    api().BindBufferRange(GL_SHADER_STORAGE_BUFFER, binding, id(),
                          static_cast<GLintptr>(byte_offset), static_cast<GLsizeiptr>(byte_count));
}

VertexArray::VertexArray() : handle_(new_object(ObjectKind::vertex_array)) {
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
    // Attribute `location` uses the binding point of the same number.
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
