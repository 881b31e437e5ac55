// SPDX-License-Identifier: Apache-2.0
#include "executors/gl_pixels.h"

#include <algorithm>
#include <cstring>
#include <glm/gtc/packing.hpp>
#include <span>

#include "base/enum_words.h"
#include "base/parallel.h"

namespace lamina {
namespace {

// Words to which the beginnings of rows are aligned: no driver needs more than 256 bytes where a
// storage block begins (OpenGL 4.5, table 23.65).
constexpr int row_alignment = 64;

std::int64_t ceil_to(std::int64_t value, std::int64_t step) {
    return (value + step - 1) / step * step;
}

// Unpacks numbers of so many bits, whose values these are.
template <int bits>
void unpack(const std::uint32_t* words, const std::vector<float>& values,
            std::span<float> numbers) {
    constexpr std::size_t in_word = 32 / bits;
    constexpr std::uint32_t mask = (1u << bits) - 1;
    for (std::size_t i = 0; i < numbers.size(); ++i)
        numbers[i] = values[words[i / in_word] >> (bits * (i % in_word)) & mask];
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

glm::ivec2 tile_size(int group) {
    return {group > 64 ? 16 : 8, group < 64 ? 4 : 8};
}

glm::ivec2 set_pixels(gl::Program& program, const DrawnPixels& pixels, int group) {
    const glm::ivec2 begin(pixels.first_column, pixels.first_row);
    const glm::ivec2 end(pixels.end_column, pixels.end_row);
    program.set("drawn_begin", begin);
    program.set("drawn_end", end);
    const glm::ivec2 tile = tile_size(group);
    return (end - begin + tile - 1) / tile;
}

void dispatch_pixels(gl::Program& program, const DrawnPixels& pixels) {
    if (pixels.empty()) return;
    const glm::ivec2 tiles = set_pixels(program, pixels, 64);
    program.dispatch(tiles.x, tiles.y);
}

GlPixels::GlPixels(PixelPacking packing, int width, int height)
    : packing_(packing),
      width_(width),
      height_(height),
      row_words_(static_cast<int>(ceil_to(std::int64_t{words_of(packing)} * width, row_alignment))),
      words_(
          gl::Buffer::make_readable(sizeof(std::uint32_t) * static_cast<std::size_t>(row_words_) *
                                    static_cast<std::size_t>(height))) {}

void GlPixels::bind(unsigned binding, int first_row, int rows) const {
    const std::size_t row_bytes = sizeof(std::uint32_t) * static_cast<std::size_t>(row_words_);
    words_.bind_storage(binding, static_cast<std::size_t>(first_row) * row_bytes,
                        static_cast<std::size_t>(rows) * row_bytes);
}

void GlPixels::read(Image& image, double largest) const {
    const std::size_t row_bytes = sizeof(std::uint32_t) * static_cast<std::size_t>(row_words_);
    const int at_once = gl::ReadBack::rows_at_once(row_bytes);
    for (int first = 0; first < height_; first += at_once) {
        const int rows = std::min(at_once, height_ - first);
        reading_.take(words_, static_cast<std::size_t>(first) * row_bytes,
                      static_cast<std::size_t>(rows) * row_bytes);
        image.resize(width_, height_);
        set_values(largest);
        unpack_rows(image, first, rows);
    }
}

void GlPixels::unpack_rows(Image& image, int first, int rows) const {
    const std::span<const std::uint32_t> words = reading_.values<std::uint32_t>();
    parallel_for(rows, 16, [&](std::int64_t row) {
        const std::uint32_t* const from = words.data() + row * row_words_;
        const std::span numbers(image.pixel(0, first + static_cast<int>(row)),
                                4 * static_cast<std::size_t>(width_));
        if (packing_ == PixelPacking::floats)
            std::memcpy(numbers.data(), from, numbers.size_bytes());
        else if (packing_ == PixelPacking::bytes)
            unpack<8>(from, values_, numbers);
        else
            unpack<16>(from, values_, numbers);
    });
}

void GlPixels::set_values(double largest) const {
    if (packing_ == PixelPacking::floats || largest == largest_) return;
    largest_ = largest;
    values_.resize(packing_ == PixelPacking::bytes ? 1 << 8 : 1 << 16);
    for (std::size_t i = 0; i < values_.size(); ++i) {
        values_[i] = packing_ == PixelPacking::halves
                         ? glm::unpackHalf1x16(static_cast<std::uint16_t>(i))
                         : static_cast<float>(static_cast<double>(i) / largest);
    }
}

}  // namespace lamina
