// SPDX-License-Identifier: Apache-2.0
#include "gl/texture.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <utility>

#include <glad/gl.h>
#include "base/error.h"
#include "gl/context.h"
#include "gl/sync.h"
#include "plan/capabilities.h"

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

namespace {

void check_side(const char* side, int found, int most) {
    if (found < 1 || found > most)
        fail("texture {} {}: this OpenGL allows 1 to {}", side, found, most);
}

// Sides are at most 2^15, so that the product cannot overflow.
std::int64_t texel_count(const TexelBox& box) {
    return std::int64_t{box.width} * box.height * box.depth;
}

[[maybe_unused]] bool contains(const TexelBox& outer, const TexelBox& inner) {
    return inner.x >= 0 && inner.y >= 0 && inner.z >= 0 && inner.width >= 1 && inner.height >= 1 &&
           inner.depth >= 1 && inner.x + inner.width <= outer.width &&
           inner.y + inner.height <= outer.height && inner.z + inner.depth <= outer.depth;
}

}  // namespace

Texture Texture::make_1d(TextureFormat format, int width) {
    return Texture(GL_TEXTURE_1D, format, {.width = width}, 1);
}

Texture Texture::make_2d(TextureFormat format, int width, int height) {
    return Texture(GL_TEXTURE_2D, format, {.width = width, .height = height}, 1);
}

Texture Texture::make_3d(TextureFormat format, int width, int height, int depth) {
    return Texture(GL_TEXTURE_3D, format, {.width = width, .height = height, .depth = depth},
                   integer(GL_MAX_3D_TEXTURE_SIZE));
}

Texture::Texture(unsigned target, TextureFormat format, const TexelBox& whole, int max_depth)
    : target_(target), format_(format), whole_(whole) {
    const int most =
        integer(target == GL_TEXTURE_3D ? GL_MAX_3D_TEXTURE_SIZE : GL_MAX_TEXTURE_SIZE);
    check_side("width", whole.width, most);
    check_side("height", whole.height, most);
    check_side("depth", whole.depth, max_depth);
    const TextureFormatInfo& info = info_of(format);
    const std::int64_t bytes = texel_count(whole) * info.bytes_per_texel;
    const std::uint64_t most_bytes = current_context()->capabilities().max_texture_bytes;
    if (static_cast<std::uint64_t>(bytes) > most_bytes) {
        fail("texture of {} x {} x {} {} takes {} bytes, at most {} are allowed", whole.width,
             whole.height, whole.depth, info.name, bytes, most_bytes);
    }
    require_memory_left(bytes + memory_for_drawing);
    allocate();
    check(fmt::format("allocating a texture of {} x {} x {} {}", whole.width, whole.height,
                      whole.depth, info.name));
    bytes_ = AllocatedBytes(bytes);
}

void Texture::allocate() {
    GLuint id = 0;
    api().CreateTextures(target_, 1, &id);
    handle_ = Handle<ObjectKind::texture>(id);
    const GLenum internal = info_of(format_).internal_format;
    switch (target_) {
        case GL_TEXTURE_1D:
            api().TextureStorage1D(id, 1, internal, width());
            break;
        case GL_TEXTURE_2D:
            api().TextureStorage2D(id, 1, internal, width(), height());
            break;
        default:
            api().TextureStorage3D(id, 1, internal, width(), height(), depth());
            break;
    }
    for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
        api().TextureParameteri(id, wrap, GL_CLAMP_TO_EDGE);
    set_filter(TextureFilter::nearest);
}

void Texture::set_filter(TextureFilter filter) {
    const GLint mode = filter == TextureFilter::linear ? GL_LINEAR : GL_NEAREST;
    api().TextureParameteri(id(), GL_TEXTURE_MIN_FILTER, mode);
    api().TextureParameteri(id(), GL_TEXTURE_MAG_FILTER, mode);
}

void Texture::bind(unsigned unit) const {
    api().BindTextureUnit(unit, id());
}

void Texture::upload(const TexelBox& box, std::span<const std::uint8_t> components) {
    upload_components(box, GL_UNSIGNED_BYTE, components.data(), components.size());
}

void Texture::upload(const TexelBox& box, std::span<const std::uint16_t> components) {
    upload_components(box, GL_UNSIGNED_SHORT, components.data(), components.size());
}

void Texture::upload(const TexelBox& box, std::span<const std::int16_t> components) {
    upload_components(box, GL_SHORT, components.data(), components.size());
}

void Texture::upload(const TexelBox& box, std::span<const float> components) {
    upload_components(box, GL_FLOAT, components.data(), components.size());
}

void Texture::upload_components(const TexelBox& box, unsigned type, const void* components,
                                [[maybe_unused]] std::size_t count) {
    const TextureFormatInfo& info = info_of(format_);
    assert(type == info.component_type);
    assert(contains(whole_, box));
    assert(std::cmp_greater_equal(count, texel_count(box) * info.channels));
    current_context()->counts().bytes_uploaded += texel_count(box) * info.bytes_per_texel;
    switch (target_) {
        case GL_TEXTURE_1D:
            api().TextureSubImage1D(id(), 0, box.x, box.width, info.layout, type, components);
            break;
        case GL_TEXTURE_2D:
            api().TextureSubImage2D(id(), 0, box.x, box.y, box.width, box.height, info.layout, type,
                                    components);
            break;
        default:
            api().TextureSubImage3D(id(), 0, box.x, box.y, box.z, box.width, box.height, box.depth,
                                    info.layout, type, components);
            break;
    }
    check("uploading a texture");
}

std::vector<float> Texture::read_rgba() const {
    ReadBack reading;
    reading.take(*this);
    const std::span<const float> rgba = reading.values<float>();
    return {rgba.begin(), rgba.end()};
}

TexelBuffer::TexelBuffer(int components, std::size_t texels)
    : buffer_(texels * static_cast<std::size_t>(components) * sizeof(std::uint32_t)) {
    const auto most = static_cast<std::size_t>(integer(GL_MAX_TEXTURE_BUFFER_SIZE));
    if (texels > most) fail("buffer of {} texels: this OpenGL allows {}", texels, most);
    GLuint id = 0;
    api().CreateTextures(GL_TEXTURE_BUFFER, 1, &id);
    handle_ = Handle<ObjectKind::texture>(id);
    api().TextureBuffer(id, components == 1 ? GL_R32UI : GL_RGBA32UI, buffer_.id());
    check("making a buffer of texels");
}

void TexelBuffer::reserve(int components, std::size_t texels) {
    const std::size_t bytes = texels * static_cast<std::size_t>(components) * sizeof(std::uint32_t);
    if (byte_count() >= bytes) return;
    const auto most = static_cast<std::size_t>(current_context()->capabilities().max_buffer_texels);
    *this = TexelBuffer(components, std::max(texels, std::min(texels + texels / 2, most)));
}

void TexelBuffer::bind(unsigned unit) const {
    api().BindTextureUnit(unit, handle_.id());
}

}  // namespace lamina::gl
