// SPDX-License-Identifier: Apache-2.0
#include "papers/palette_slices.h"

#include <span>

#include "compositing/dither.h"
#include "compositing/random_bits.h"
#include "executors/gl_compositing.h"
#include "gl/full_screen.h"

namespace lamina::papers {
namespace {

constexpr int entries = 256;
constexpr std::size_t row_bytes = 4 * entries;

// Colours are white. Entry i has an opacity of .004 i codes, dithered, so that at most one code is
// shown.
std::vector<std::uint8_t> dithered_palettes(int period) {
    const std::vector<std::uint32_t> ranks = dither_ranks(period, 1);
    std::vector<std::uint8_t> palettes;
    for (const std::uint32_t rank : ranks) {
        for (int entry = 0; entry < entries; ++entry) {
            const std::uint32_t code = dither_code(0.004 * entry, rank, period, 1, 255);
            palettes.insert(palettes.end(), 4, static_cast<std::uint8_t>(code));
        }
    }
    return palettes;
}

gl::Texture random_indices(int pixels) {
    SplitMix64 random(1);
    std::vector<std::uint8_t> indices(static_cast<std::size_t>(pixels) *
                                      static_cast<std::size_t>(pixels));
    for (std::uint8_t& index : indices) index = static_cast<std::uint8_t>(random.next() >> 56);
    gl::Texture texture = gl::Texture::make_2d(gl::TextureFormat::r8, pixels, pixels);
    texture.upload({0, 0, 0, pixels, pixels, 1}, std::span<const std::uint8_t>(indices));
    return texture;
}

gl::Defines defines_of(PaletteSlices::Way way, int period) {
    gl::Defines defines;
    if (way == PaletteSlices::Way::lookup) defines.set("PALETTES", period);
    return defines;
}

}  // namespace

PaletteSlices::PaletteSlices(Way way, int pixels, int slices, int period)
    : way_(way),
      slices_(slices),
      period_(period),
      palettes_(dithered_palettes(period)),
      indices_(random_indices(pixels)),
      palette_(
          gl::Texture::make_2d(gl::TextureFormat::rgba8, entries, way == Way::lookup ? period : 1)),
      target_(gl::Texture::make_2d(gl::TextureFormat::rgba8, pixels, pixels)),
      program_("gl/full_screen.vert", "study/palette.frag", defines_of(way, period)) {
    program_.set("indices", 0);
    program_.set("palette", 1);
    if (way == Way::lookup) {
        palette_.upload({0, 0, 0, entries, period, 1}, std::span<const std::uint8_t>(palettes_));
    }
}

Image PaletteSlices::draw() {
    target_.bind();
    target_.clear(glm::vec4(0));
    indices_.bind(0);
    palette_.bind(1);
    const CompositingState blending(CompositingPlan{}, false, target_);
    const std::span<const std::uint8_t> palettes(palettes_);
    for (int slice = 0; slice < slices_; ++slice) {
        if (way_ == Way::upload) {
            const auto row = static_cast<std::size_t>(slice % period_);
            palette_.upload({0, 0, 0, entries, 1, 1}, palettes.subspan(row * row_bytes, row_bytes));
        }
        program_.set("slice", slice);
        gl::draw_full_screen(program_, no_attributes_);
    }
    return target_.read_back();
}

}  // namespace lamina::papers
