// SPDX-License-Identifier: Apache-2.0
#include "gl/api.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <string>

#include <glad/gl.h>
#include "base/error.h"
#include "gl/context.h"

namespace lamina::gl {

namespace {

const char* name_of(GLenum error) {
    switch (error) {
        case GL_INVALID_ENUM:
            return "GL_INVALID_ENUM";
        case GL_INVALID_VALUE:
            return "GL_INVALID_VALUE";
        case GL_INVALID_OPERATION:
            return "GL_INVALID_OPERATION";
        case GL_INVALID_FRAMEBUFFER_OPERATION:
            return "GL_INVALID_FRAMEBUFFER_OPERATION";
        case GL_OUT_OF_MEMORY:
            return "GL_OUT_OF_MEMORY";
        case GL_STACK_OVERFLOW:
            return "GL_STACK_OVERFLOW";
        case GL_STACK_UNDERFLOW:
            return "GL_STACK_UNDERFLOW";
        case GL_CONTEXT_LOST:
            return "GL_CONTEXT_LOST";
        default:
            return "unknown error";
    }
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
    // A lost context reports errors for ever.
    for (int i = 0; i < 32 && api().GetError() != GL_NO_ERROR; ++i) {
    }
    const std::string message = take_debug_message();
    fail("OpenGL: {} while {}{}{}", name_of(first), where, message.empty() ? "" : ": ", message);
}

void delete_object(ObjectKind kind, unsigned id) {
    switch (kind) {
        case ObjectKind::buffer:
            api().DeleteBuffers(1, &id);
            break;
        case ObjectKind::texture:
            api().DeleteTextures(1, &id);
            break;
        case ObjectKind::vertex_array:
            api().DeleteVertexArrays(1, &id);
            break;
        case ObjectKind::framebuffer:
            api().DeleteFramebuffers(1, &id);
            break;
        case ObjectKind::query:
            api().DeleteQueries(1, &id);
            break;
        case ObjectKind::shader:
            api().DeleteShader(id);
            break;
        case ObjectKind::program:
            api().DeleteProgram(id);
            break;
    }
}

namespace {

constexpr std::int64_t mebibyte = 1 << 20;

}  // namespace

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

}  // namespace lamina::gl
