// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace lamina::gl {

// r8, r16, rgba8, rgba16: codes that read as code/255 and code/65535. rgba16i: whole numbers, for
// isamplers.
enum class TextureFormat { r8, r16, r16f, r32f, rg32f, rgba8, rgba16, rgba16i, rgba16f, rgba32f };

struct TextureFormatInfo {
    const char* name;
    int channels;
    int bytes_per_texel;       // in GPU memory
    unsigned internal_format;  // GL_R8, ...
    unsigned layout;  // of texels in host memory: GL_RED, GL_RG, GL_RGBA or GL_RGBA_INTEGER
    // Their type there: GL_UNSIGNED_BYTE, GL_UNSIGNED_SHORT, GL_SHORT or GL_FLOAT.
    unsigned component_type;
};

const TextureFormatInfo& info_of(TextureFormat format);

}  // namespace lamina::gl
