// SPDX-License-Identifier: Apache-2.0
#include "gl/texture_format.h"

#include <glad/gl.h>

#include <array>
#include <cstddef>

namespace lamina::gl {

const TextureFormatInfo& info_of(TextureFormat format) {
    static constexpr std::array<TextureFormatInfo, 10> table{{
        {"R8", 1, 1, GL_R8, GL_RED, GL_UNSIGNED_BYTE},
        {"R16", 1, 2, GL_R16, GL_RED, GL_UNSIGNED_SHORT},
        {"R16F", 1, 2, GL_R16F, GL_RED, GL_FLOAT},
        {"R32F", 1, 4, GL_R32F, GL_RED, GL_FLOAT},
        {"RG32F", 2, 8, GL_RG32F, GL_RG, GL_FLOAT},
        {"RGBA8", 4, 4, GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE},
        {"RGBA16", 4, 8, GL_RGBA16, GL_RGBA, GL_UNSIGNED_SHORT},
        {"RGBA16I", 4, 8, GL_RGBA16I, GL_RGBA_INTEGER, GL_SHORT},
        {"RGBA16F", 4, 8, GL_RGBA16F, GL_RGBA, GL_FLOAT},
        {"RGBA32F", 4, 16, GL_RGBA32F, GL_RGBA, GL_FLOAT},
    }};
    return table[static_cast<std::size_t>(format)];
}

}  // namespace lamina::gl
