// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace lamina::gl {

// r8, r16, rgba8, rgba16: codes that read as code/255 and code/65535.
enum class TextureFormat { r8, r16, r16f, r32f, rg32f, rgba8, rgba16, rgba16f, rgba32f };

struct TextureFormatInfo {
    const char* name;
    int channels;
    int bytes_per_texel;       // in GPU memory
    unsigned internal_format;  // GL_R8, ...
    unsigned layout;           // of texels in host memory: GL_RED, GL_RG or GL_RGBA
    // The type of texels in host memory: GL_UNSIGNED_BYTE, GL_UNSIGNED_SHORT or GL_FLOAT.
    unsigned component_type;
};

const TextureFormatInfo& info_of(TextureFormat format);

}  // namespace lamina::gl
