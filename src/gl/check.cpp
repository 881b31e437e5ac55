// SPDX-License-Identifier: Apache-2.0
#include "gl/check.h"

#include <glad/gl.h>

#include <algorithm>
#include <array>
#include <string>

#include "base/error.h"
#include "gl/api.h"

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

// Returns the driver's own words on the oldest error, and empties its log.
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

}  // namespace lamina::gl
