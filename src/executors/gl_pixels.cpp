// SPDX-License-Identifier: Apache-2.0
#include "executors/gl_pixels.h"

#include <algorithm>
#include <bit>
#include <glm/gtc/packing.hpp>
#include <span>

#include "base/enum_words.h"

namespace lamina {
namespace {

// Words to which the beginnings of rows are aligned: no driver needs more than 256 bytes where a
// storage block begins (OpenGL 4.5, table 23.65).
constexpr int row_alignment = 64;

constexpr int tile_edge = 8;  // of shaders/gl/tile.glsl

std::int64_t ceil_to(std::int64_t value, std::int64_t step) {
    return (value + step - 1) / step * step;
}

// Sets the four channels of a pixel from its words.
void unpack(PixelPacking packing, const std::uint32_t* words, double largest, float* rgba) {
    for (int channel = 0; channel < 4; ++channel) {
        const std::uint32_t pair = words[packing == PixelPacking::bytes ? 0 : channel / 2];
        const auto half = static_cast<std::uint16_t>(channel % 2 != 0 ? pair >> 16 : pair);
        switch (packing) {
            case PixelPacking::floats:
                rgba[channel] = std::bit_cast<float>(words[channel]);
                break;
            case PixelPacking::halves:
                rgba[channel] = glm::unpackHalf1x16(half);
                break;
            case PixelPacking::shorts:
                rgba[channel] = static_cast<float>(half / largest);
                break;
            case PixelPacking::bytes:
                rgba[channel] = static_cast<float>((pair >> (8 * channel) & 255) / largest);
                break;
        }
    }
}

}  // namespace

PixelPacking packing_of(const CompositingPlan& plan) {
    switch (plan.target) {
        case Target::float32:
            return PixelPacking::floats;
        case Target::float16:
            return PixelPacking::halves;
        case Target::fixed16:
        case Target::fixed8:
        case Target::emulated:
            return plan.code_bits() > 8 ? PixelPacking::shorts : PixelPacking::bytes;
    }
    unreachable_enum();
}

int words_of(PixelPacking packing) {
    switch (packing) {
        case PixelPacking::floats:
            return 4;
        case PixelPacking::halves:
        case PixelPacking::shorts:
            return 2;
        case PixelPacking::bytes:
            return 1;
    }
    unreachable_enum();
}

void set_packing(gl::Defines& defines, const CompositingPlan& plan) {
    defines.set("PACKING", static_cast<int>(packing_of(plan)));
}

void dispatch_pixels(gl::Program& program, const DrawnPixels& pixels) {
    if (pixels.empty()) return;
    program.set("drawn_begin", glm::ivec2(pixels.first_column, pixels.first_row));
    program.set("drawn_end", glm::ivec2(pixels.end_column, pixels.end_row));
    const auto tiles = [](int begin, int end) { return (end - begin + tile_edge - 1) / tile_edge; };
    program.dispatch(tiles(pixels.first_column, pixels.end_column),
                     tiles(pixels.first_row, pixels.end_row));
}

GlPixels::GlPixels(PixelPacking packing, int width, int height)
    : packing_(packing),
      width_(width),
      height_(height),
      row_words_(static_cast<int>(ceil_to(std::int64_t{words_of(packing)} * width, row_alignment))),
      words_(sizeof(std::uint32_t) * static_cast<std::size_t>(row_words_) *
             static_cast<std::size_t>(height)) {}

void GlPixels::bind(unsigned binding, int first_row, int rows) const {
    const std::size_t row_bytes = sizeof(std::uint32_t) * static_cast<std::size_t>(row_words_);
    words_.bind_storage(binding, static_cast<std::size_t>(first_row) * row_bytes,
                        static_cast<std::size_t>(rows) * row_bytes);
}

void GlPixels::read(Image& image, double largest) const {
    image.resize(width_, height_);
    const int words = words_of(packing_);
    if (packing_ == PixelPacking::floats && row_words_ == words * width_) {
        words_.read(std::span(image.rgba));
        return;
    }
    read_words_.resize(words_.byte_count() / sizeof(std::uint32_t));
    words_.read(std::span(read_words_));
    for (int row = 0; row < height_; ++row) {
        const std::uint32_t* const from =
            read_words_.data() +
            static_cast<std::size_t>(row) * static_cast<std::size_t>(row_words_);
        if (packing_ == PixelPacking::floats) {
            std::copy_n(reinterpret_cast<const float*>(from), 4 * width_, image.pixel(0, row));
            continue;
        }
        for (int column = 0; column < width_; ++column)
            unpack(packing_, from + words * column, largest, image.pixel(column, row));
    }
}

}  // namespace lamina
