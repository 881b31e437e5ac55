// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "gl/api.h"

namespace lamina::gl {

// r8, r16, rgba8, rgba16: codes that read as code/255, code/65535. rgba16i: whole, for isamplers.
enum class TextureFormat { r8, r16, r16f, r32f, rg32f, rgba8, rgba16, rgba16i, rgba16f, rgba32f };

struct TextureFormatInfo {
    const char* name;
    int channels;
    int bytes_per_texel;       // in GPU memory
    unsigned internal_format;  // GL_R8, ...
    unsigned layout;           // layout in host memory: GL_RED, GL_RG, GL_RGBA or GL_RGBA_INTEGER
    // Type of components there: GL_UNSIGNED_BYTE, GL_UNSIGNED_SHORT, GL_SHORT or GL_FLOAT.
    unsigned component_type;
};

const TextureFormatInfo& info_of(TextureFormat format);

enum class TextureFilter { nearest, linear };

// A box of texels: first texel and size. For a 2D array, z counts layers.
struct TexelBox {
    int x = 0, y = 0, z = 0;
    int width = 1, height = 1, depth = 1;
};

// The layout of texels in memory: texels from row to row and rows from slice to slice, as for a box
// cut out of a larger grid. 0 means the box's own width or height.
struct PixelStore {
    int row_length = 0;
    int slice_rows = 0;
};

// A texture of fixed size and one level, clamped to its edge, filtered `nearest` at first;
// undefined until uploaded or drawn. Throws Error for sizes below 1 or over the context's limits,
// for more than Capabilities::max_texture_bytes, and if the driver is out of memory.
class Texture {
  public:
    Texture() = default;
    static Texture make_1d(TextureFormat format, int width);
    static Texture make_2d(TextureFormat format, int width, int height);
    static Texture make_2d_array(TextureFormat format, int width, int height, int layers);
    static Texture make_3d(TextureFormat format, int width, int height, int depth);

    // Fills `box` from components, x fastest, up to its last texel (assert). uint8 for r8 and
    // rgba8, uint16 for r16 and rgba16, int16 for rgba16i, float for the rest.
    void upload(const TexelBox& box, std::span<const std::uint8_t> components,
                PixelStore store = {});
    void upload(const TexelBox& box, std::span<const std::uint16_t> components,
                PixelStore store = {});
    void upload(const TexelBox& box, std::span<const std::int16_t> components,
                PixelStore store = {});
    void upload(const TexelBox& box, std::span<const float> components, PixelStore store = {});

    void set_filter(TextureFilter filter);
    void bind(unsigned unit) const;

    // Reads all texels but rgba16i as RGBA floats, x fastest, then y, then z: row 0 is OpenGL's,
    // the bottom one. Absent channels read as 0, absent alpha as 1.
    std::vector<float> read_rgba() const;
    void read_rgba(std::span<float> rgba) const;  // 4 floats a texel, exactly

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
                           std::size_t count, PixelStore store);

    unsigned target_ = 0;
    TextureFormat format_ = TextureFormat::r8;
    TexelBox whole_;
    Handle<ObjectKind::texture> handle_;
    AllocatedBytes bytes_;
};

}  // namespace lamina::gl
