// SPDX-License-Identifier: Apache-2.0
#include "slicing/gl_volume.h"

#include <cstring>
#include <span>
#include <type_traits>
#include <utility>

#include "base/client.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "slicing/gradient_map.h"
#include "slicing/slab_geometry.h"

namespace lamina {
namespace {

constexpr unsigned words_binding = 2;  // of shaders/slicing/cell_cubic.glsl

gl::TexelBox layer_of(const TextureBrick& brick, std::int64_t z) {
    return {
        0, 0, static_cast<int>(z), static_cast<int>(brick.size[0]), static_cast<int>(brick.size[1]),
        1};
}

// Hands a brick's samples to `upload(z, layer)` layer by layer, as they are stored: as codes, where
// those of int16 are shifted to begin at 0, or as floats. One layer is copied in memory at a time.
template <typename Upload>
void visit_layers(const Volume& volume, const ValueRange& range, bool as_float,
                  const TextureBrick& brick, const Upload& upload) {
    const Grid& grid = volume.grid();
    const auto convert_layers = [&]<typename Texel>(const auto* samples, auto convert, Texel) {
        std::vector<Texel> layer(static_cast<std::size_t>(brick.size[0] * brick.size[1]));
        for (std::int64_t z = 0; z < brick.size[2]; ++z) {
            check_interrupt();
            parallel_for(brick.size[1], 64, [&](std::int64_t y) {
                const BrickRow own = row_of(brick, grid, y, z);
                Texel* const to = layer.data() + y * brick.size[0];
                for (std::int64_t x = own.begin; x < own.end; ++x)
                    to[x] = convert(samples[own.first + static_cast<std::size_t>(x - own.begin)]);
                own.repeat_ends(to, brick.size[0]);
            });
            upload(z, std::span<const Texel>(layer));
        }
    };
    volume.visit([&](const auto* samples) {
        using Sample = std::remove_cvref_t<decltype(*samples)>;
        if (as_float) {
            const auto normalise = [&](Sample sample) { return normalised_sample(sample, range); };
            convert_layers(samples, normalise, float{});
        } else if constexpr (std::is_same_v<Sample, std::int16_t>) {
            const auto shift = [](Sample sample) {
                return static_cast<std::uint16_t>(sample + 32768);
            };
            convert_layers(samples, shift, std::uint16_t{});
        } else if constexpr (std::is_integral_v<Sample>) {
            convert_layers(
                samples, [](Sample sample) { return sample; }, Sample{});
        }
    });
}

gl::Texture upload_gradients(const Volume& volume, const TextureBrick& brick, Progress& progress) {
    const auto row_size = static_cast<std::size_t>(brick.size[0]);
    gl::Texture texture =
        gl::Texture::make_3d(gl::TextureFormat::rgba16i, static_cast<int>(brick.size[0]),
                             static_cast<int>(brick.size[1]), static_cast<int>(brick.size[2]));
    std::vector<StoredGradient> layer(row_size * static_cast<std::size_t>(brick.size[1]));
    for (std::int64_t z = 0; z < brick.size[2]; ++z) {
        parallel_for(brick.size[1], 16, [&](std::int64_t y) {
            set_gradient_row(
                volume, brick, y, z,
                std::span(layer).subspan(static_cast<std::size_t>(y) * row_size, row_size));
        });
        texture.upload(
            layer_of(brick, z),
            std::span(reinterpret_cast<const std::int16_t*>(layer.data()), 4 * layer.size()));
        progress.advance();
    }
    return texture;
}

// Returns the bits of a sample in OpenGL's memory: 8 or 16 of a code, or 32 of a float.
int stored_bits(const Volume& volume, const SlicePlan& plan) {
    if (plan.float_texture) return 32;
    return volume.type() == SampleType::uint8 ? 8 : 16;
}

}  // namespace

GlVolume::GlVolume(const Volume& volume, const ValueRange& range, const SlicePlan& plan)
    : volume_(volume),
      range_(range),
      parts_(plan.bricks),
      float_samples_(plan.float_texture),
      filtered_(plan.sampling != VolumeSampling::fetch) {
    if (!volume.in_memory()) {
        fail(
            "the volume does not fit the memory limit of {} bytes, and OpenGL draws volumes in "
            "memory alone: expected the cpu engine, or more memory",
            memory_limit());
    }
    std::int64_t layers = 0;
    for (const TextureBrick& brick : parts_) layers += brick.size[2];
    Progress progress("uploading the volume", plan.lighting ? 2 * layers : layers);
    const int bits = stored_bits(volume, plan);
    const gl::TextureFormat format = bits == 32  ? gl::TextureFormat::r32f
                                     : bits == 8 ? gl::TextureFormat::r8
                                                 : gl::TextureFormat::r16;
    for (const TextureBrick& brick : parts_) {
        const auto layer_bytes =
            static_cast<std::size_t>(brick.size[0] * brick.size[1] * (bits / 8));
        if (plan.words) {
            const std::size_t bytes = layer_bytes * static_cast<std::size_t>(brick.size[2]);
            words_.emplace_back((bytes + 3) / 4 * 4);
        } else {
            textures_.push_back(gl::Texture::make_3d(format, static_cast<int>(brick.size[0]),
                                                     static_cast<int>(brick.size[1]),
                                                     static_cast<int>(brick.size[2])));
            if (filtered_) textures_.back().set_filter(gl::TextureFilter::linear);
        }
        visit_layers(volume, range, float_samples_, brick, [&](std::int64_t z, auto layer) {
            if (plan.words) {
                words_.back().write(layer, static_cast<std::size_t>(z) * layer_bytes);
            } else {
                textures_.back().upload(layer_of(brick, z), layer);
            }
            progress.advance();
        });
        if (plan.lighting) gradients_.push_back(upload_gradients(volume, brick, progress));
    }
}

// Codes do not depend on the range, which normalises floats only.
bool GlVolume::can_replace(const Volume& volume, const ValueRange& range,
                           const SlicePlan& plan) const {
    return volume.shares_samples(volume_) && plan.bricks == parts_ &&
           plan.words != words_.empty() && plan.float_texture == float_samples_ &&
           (!float_samples_ || range == range_) &&
           (plan.sampling != VolumeSampling::fetch) == filtered_ &&
           plan.lighting.has_value() == !gradients_.empty();
}

void GlVolume::bind(std::size_t brick, unsigned unit) const {
    if (words_.empty()) {
        textures_[brick].bind(unit);
    } else {
        words_[brick].bind_storage(words_binding);
    }
}

}  // namespace lamina
