// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "gl/api.h"

namespace lamina::gl {

// Shaders read code / 255 (r8, rgba8), code / 65535 (r16, rgba16), integers (rgba16i: isampler).
enum class TextureFormat { r8, r16, r16f, r32f, rg32f, rgba8, rgba16, rgba16i, rgba16f, rgba32f };

// A TextureFormat in OpenGL's terms.
struct TextureFormatInfo {
    const char* name;
    int channels;
    int bytes_per_texel;       // in GPU memory
    unsigned internal_format;  // GL_R8, ...
    unsigned layout;           // layout in host memory: GL_RED, GL_RG, GL_RGBA or GL_RGBA_INTEGER
    // Type of components in host memory: GL_UNSIGNED_BYTE, GL_UNSIGNED_SHORT, GL_SHORT or GL_FLOAT.
    unsigned component_type;
};

const TextureFormatInfo& info_of(TextureFormat format);

enum class TextureFilter { nearest, linear };

// A box of texels: first texel and size.
struct TexelBox {
    int x = 0, y = 0, z = 0;
    int width = 1, height = 1, depth = 1;
};

// A texture of one level and fixed size, clamped to its edge, `nearest` at first, undefined until
// filled. Throws Error for sizes below 1, beyond limits (max_texture_bytes), or out of memory.
class Texture {
  public:
    Texture() = default;
    static Texture make_1d(TextureFormat format, int width);
    static Texture make_2d(TextureFormat format, int width, int height);
    static Texture make_3d(TextureFormat format, int width, int height, int depth);

    // Fills `box`, x fastest, from `components`, which must reach its last texel (assert): uint8
    // for r8 and rgba8, uint16 for r16 and rgba16, int16 for rgba16i, float for the rest.
    void upload(const TexelBox& box, std::span<const std::uint8_t> components);
    void upload(const TexelBox& box, std::span<const std::uint16_t> components);
    void upload(const TexelBox& box, std::span<const std::int16_t> components);
    void upload(const TexelBox& box, std::span<const float> components);

    void set_filter(TextureFilter filter);
    void bind(unsigned unit) const;

    std::vector<float> read_rgba() const;  // waits for ReadBack::take()

    unsigned id() const { return handle_.id(); }
    TextureFormat format() const { return format_; }
    int width() const { return whole_.width; }
    int height() const { return whole_.height; }
    int depth() const { return whole_.depth; }
    std::int64_t byte_count() const { return bytes_.count(); }

  private:
    Texture(unsigned target, TextureFormat format, const TexelBox& whole, int max_depth);
    void allocate();
    void upload_components(const TexelBox& box, unsigned type, const void* components,
                           std::size_t count);

    unsigned target_ = 0;
    TextureFormat format_ = TextureFormat::r8;
    TexelBox whole_;
    Handle<ObjectKind::texture> handle_;
    AllocatedBytes bytes_;
};

// A buffer that shaders read as texels of one or four 32-bit integers (usamplerBuffer) or as a
// storage block, for tables that are too long for other textures. Undefined until written.
class TexelBuffer {
  public:
    TexelBuffer() = default;
    // `components`: 1 or 4. Throws Error if OpenGL allows fewer texels.
    TexelBuffer(int components, std::size_t texels);
    // Makes a larger one in its place, undefined again, if it does not hold so many texels.
    void reserve(int components, std::size_t texels);

    // Replaces the texels from the first on.
    template <typename T, std::size_t extent>
    void write(std::span<T, extent> elements) {
        buffer_.write(elements);
    }
    void bind(unsigned unit) const;
    void bind_storage(unsigned binding) const { buffer_.bind_storage(binding); }
    std::size_t byte_count() const { return buffer_.byte_count(); }

  private:
    Buffer buffer_;
    Handle<ObjectKind::texture> handle_;
};

}  // namespace lamina::gl
