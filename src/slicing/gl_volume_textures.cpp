// SPDX-License-Identifier: Apache-2.0
#include "slicing/gl_volume_textures.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "facts/drawn_range.h"
#include "slicing/gradient_map.h"
#include "slicing/texture_bricks.h"

namespace lamina {
namespace {

gl::TexelBox layer_of(const TextureBrick& brick, std::int64_t z) {
    return {
        0, 0, static_cast<int>(z), static_cast<int>(brick.size[0]), static_cast<int>(brick.size[1]),
        1};
}

// Uploads the brick layer by layer after converting each sample; the layer is the only copy in
// memory.
template <typename Texel, typename Sample, typename Convert>
void upload_converted(const Grid& grid, const TextureBrick& brick, const Sample* samples,
                      const Convert& convert, gl::Texture& texture, Progress& progress) {
    std::vector<Texel> layer(static_cast<std::size_t>(brick.size[0] * brick.size[1]));
    for (std::int64_t z = 0; z < brick.size[2]; ++z) {
        parallel_for(brick.size[1], 64, [&](std::int64_t y) {
            const BrickRow own = row_of(brick, grid, y, z);
            const Sample* const from = samples + own.first;
            Texel* const to = layer.data() + y * brick.size[0];
            for (std::int64_t x = own.begin; x < own.end; ++x) to[x] = convert(from[x - own.begin]);
            own.repeat_ends(to, brick.size[0]);
        });
        texture.upload(layer_of(brick, z), std::span<const Texel>(layer));
        progress.advance();
    }
}

// Uploads the samples as they lie in memory.
template <typename Texel>
void upload_in_place(const Grid& grid, const TextureBrick& brick, const Texel* samples,
                     gl::Texture& texture, Progress& progress) {
    const gl::PixelStore store{static_cast<int>(grid.size[0]), static_cast<int>(grid.size[1])};
    const std::size_t count =
        static_cast<std::size_t>((brick.size[1] - 1) * grid.size[0] + brick.size[0]);
    for (std::int64_t z = 0; z < brick.size[2]; ++z) {
        check_interrupt();
        texture.upload(layer_of(brick, z),
                       std::span<const Texel>(samples + row_of(brick, grid, 0, z).first, count),
                       store);
        progress.advance();
    }
}

void upload_brick(const Volume& volume, const ValueRange& range, bool as_float,
                  const TextureBrick& brick, gl::Texture& texture, Progress& progress) {
    const Grid& grid = volume.grid();
    if (as_float) {
        const auto normalise = [&](auto sample) { return normalised_sample(sample, range); };
        volume.visit([&](const auto* samples) {
            upload_converted<float>(grid, brick, samples, normalise, texture, progress);
        });
    } else if (volume.type() == SampleType::int16) {
        const auto shift = [](std::int16_t sample) {
            return static_cast<std::uint16_t>(sample + 32768);
        };
        upload_converted<std::uint16_t>(
            grid, brick, static_cast<const std::int16_t*>(volume.data()), shift, texture, progress);
    } else if (volume.type() == SampleType::uint16) {
        upload_in_place(grid, brick, static_cast<const std::uint16_t*>(volume.data()), texture,
                        progress);
    } else {
        upload_in_place(grid, brick, static_cast<const std::uint8_t*>(volume.data()), texture,
                        progress);
    }
}

// Uploads layer by layer, as above.
gl::Texture upload_gradients(const Volume& volume, const TextureBrick& brick, Progress& progress) {
    const auto row_size = static_cast<std::size_t>(brick.size[0]);
    gl::Texture texture =
        gl::Texture::make_3d(gl::TextureFormat::rgba16i, static_cast<int>(brick.size[0]),
                             static_cast<int>(brick.size[1]), static_cast<int>(brick.size[2]));
    std::vector<StoredGradient> layer(row_size * static_cast<std::size_t>(brick.size[1]));
    std::vector<std::int16_t> components;
    for (std::int64_t z = 0; z < brick.size[2]; ++z) {
        parallel_for(brick.size[1], 16, [&](std::int64_t y) {
            set_gradient_row(
                volume, brick, y, z,
                std::span(layer).subspan(static_cast<std::size_t>(y) * row_size, row_size));
        });
        components.clear();
        for (const StoredGradient& gradient : layer) {
            components.insert(components.end(), gradient.component.begin(),
                              gradient.component.end());
            components.push_back(gradient.exponent);
        }
        texture.upload(layer_of(brick, z), std::span<const std::int16_t>(components));
        progress.advance();
    }
    return texture;
}

}  // namespace

VolumeTextures::VolumeTextures(const Volume& volume, const ValueRange& range, const SlicePlan& plan)
    : volume_(volume),
      range_(range),
      parts_(plan.bricks),
      float_texture_(plan.float_texture),
      filtered_(plan.sampling != VolumeSampling::fetch) {
    if (!volume.in_memory()) {
        fail(
            "the volume does not fit the memory limit of {} bytes, and OpenGL draws volumes in "
            "memory alone: expected the native engine, or more memory",
            memory_limit());
    }
    std::int64_t layers = 0;
    for (const TextureBrick& brick : parts_) layers += brick.size[2];
    Progress progress("uploading the volume", plan.lighting ? 2 * layers : layers);
    const gl::TextureFormat format = float_texture_                       ? gl::TextureFormat::r32f
                                     : volume.type() == SampleType::uint8 ? gl::TextureFormat::r8
                                                                          : gl::TextureFormat::r16;
    for (const TextureBrick& brick : parts_) {
        gl::Texture texture =
            gl::Texture::make_3d(format, static_cast<int>(brick.size[0]),
                                 static_cast<int>(brick.size[1]), static_cast<int>(brick.size[2]));
        if (filtered_) texture.set_filter(gl::TextureFilter::linear);
        upload_brick(volume, range, float_texture_, brick, texture, progress);
        bricks_.push_back(std::move(texture));
        if (plan.lighting) gradients_.push_back(upload_gradients(volume, brick, progress));
    }
}

// Codes are those of the volume, whatever its range.
bool VolumeTextures::serves(const Volume& volume, const ValueRange& range,
                            const SlicePlan& plan) const {
    return volume.shares_samples(volume_) && plan.bricks == parts_ &&
           plan.float_texture == float_texture_ && (!float_texture_ || range == range_) &&
           (plan.sampling != VolumeSampling::fetch) == filtered_ &&
           plan.lighting.has_value() == !gradients_.empty();
}

// Codes of int16 are shifted to begin at 0.
SampleCodes sample_codes(const Volume& volume, const ValueRange& range, const SlicePlan& plan) {
    if (plan.float_texture) return {};
    const double shift = volume.type() == SampleType::int16 ? 32768 : 0;
    return {volume.type() == SampleType::uint8 ? 255.0 : 65535.0, range.lo + shift,
            range.hi > range.lo ? 1 / (range.hi - range.lo) : 0};
}

}  // namespace lamina
