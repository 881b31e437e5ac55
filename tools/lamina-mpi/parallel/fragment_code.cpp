// SPDX-License-Identifier: Apache-2.0
#include "parallel/fragment_code.h"

#include <Imath/half.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>
#include <limits>

#include "base/enum_words.h"
#include "base/error.h"

namespace lamina {
namespace {

// Returns true if any of the `pixels` pixels from `column` on shows something, that is, has a bit
// set. All bits are joined by OR first, which is faster than testing each pixel.
template <int pixels>
bool any_shows(const float* row, int column) {
    std::uint64_t words[2 * pixels], any = 0;
    std::memcpy(words, row + 4 * static_cast<std::size_t>(column), sizeof words);
    for (const std::uint64_t word : words) any |= word;
    return any != 0;
}

int first_shown(const float* row, int column, int width) {
    while (column + 8 <= width && !any_shows<8>(row, column)) column += 8;
    while (column < width && !any_shows<1>(row, column)) ++column;
    return column;
}

int first_hidden(const float* row, int column, int width) {
    while (column < width && any_shows<1>(row, column)) ++column;
    return column;
}

using Pixel = std::array<float, 4>;

// Composites `pixel` behind `front`: OVER for associated alpha.
void put_behind(const Pixel& pixel, float* front) {
    const float left = 1 - front[3];
    for (std::size_t channel = 0; channel < 4; ++channel) front[channel] += left * pixel[channel];
}

template <typename Code>
Code code_of(float share) {
    constexpr float most = std::numeric_limits<Code>::max();
    return static_cast<Code>(std::clamp(share * most + 0.5f, 0.0f, most));
}
template <typename Code>
float share_of(Code code) {
    return static_cast<float>(code) * (1.0f / std::numeric_limits<Code>::max());
}

// Each format has the size of a pixel in bytes, and functions to encode and decode it. A code of a
// colour is its share of `largest`, the largest colour (not associated) in the encoded rows.
struct Float32 {
    static constexpr bool has_codes = false;
    static constexpr std::size_t size = 16;
    static void encode(const float* pixel, float, std::byte* bytes) {
        std::memcpy(bytes, pixel, size);
    }
    static Pixel decode(const std::byte* bytes, float) {
        Pixel pixel;
        std::memcpy(pixel.data(), bytes, size);
        return pixel;
    }
};

struct Half {
    static constexpr bool has_codes = false;
    static constexpr std::size_t size = 8;
    static void encode(const float* pixel, float, std::byte* bytes) {
        std::array<std::uint16_t, 4> halves;
        for (std::size_t channel = 0; channel < 4; ++channel)
            halves[channel] = Imath::half(pixel[channel]).bits();
        std::memcpy(bytes, halves.data(), size);
    }
    static Pixel decode(const std::byte* bytes, float) {
        std::array<std::uint16_t, 4> halves;
        std::memcpy(halves.data(), bytes, size);
        Pixel pixel;
        for (std::size_t channel = 0; channel < 4; ++channel)
            pixel[channel] = Imath::half(Imath::half::FromBits, halves[channel]);
        return pixel;
    }
};

struct Fixed16 {
    static constexpr bool has_codes = true;
    static constexpr std::size_t size = 8;
    static void encode(const float* pixel, float largest, std::byte* bytes) {
        std::array<std::uint16_t, 4> codes;
        for (std::size_t channel = 0; channel < 3; ++channel)
            codes[channel] = code_of<std::uint16_t>(pixel[channel] / largest);
        codes[3] = code_of<std::uint16_t>(pixel[3]);
        std::memcpy(bytes, codes.data(), size);
    }
    static Pixel decode(const std::byte* bytes, float largest) {
        std::array<std::uint16_t, 4> codes;
        std::memcpy(codes.data(), bytes, size);
        return {share_of(codes[0]) * largest, share_of(codes[1]) * largest,
                share_of(codes[2]) * largest, share_of(codes[3])};
    }
};

struct Fixed8 {
    static constexpr bool has_codes = true;
    static constexpr std::size_t size = 5;
    static void encode(const float* pixel, float largest, std::byte* bytes) {
        const float scale = pixel[3] > 0 ? 1 / (pixel[3] * largest) : 0;
        for (std::size_t channel = 0; channel < 3; ++channel)
            bytes[channel] = std::byte{code_of<std::uint8_t>(pixel[channel] * scale)};
        const auto opacity = code_of<std::uint16_t>(pixel[3]);
        std::memcpy(bytes + 3, &opacity, sizeof opacity);
    }
    static Pixel decode(const std::byte* bytes, float largest) {
        std::uint16_t code;
        std::memcpy(&code, bytes + 3, sizeof code);
        const float opacity = share_of(code), scale = opacity * largest;
        const auto color = [&](std::size_t channel) {
            return share_of(std::to_integer<std::uint8_t>(bytes[channel])) * scale;
        };
        return {color(0), color(1), color(2), opacity};
    }
};

template <typename Use>
void with_format(FragmentFormat format, const Use& use) {
    switch (format) {
        case FragmentFormat::float32:
            return use(Float32());
        case FragmentFormat::half:
            return use(Half());
        case FragmentFormat::fixed16:
            return use(Fixed16());
        case FragmentFormat::fixed8:
            return use(Fixed8());
    }
    unreachable_enum();
}

// A number is stored with 7 bits in each byte, the lowest bits first. A byte's highest bit is set
// if more bytes follow. A number of 32 bits takes up to 5 bytes.
constexpr std::size_t most_number_bytes = 5;
std::byte* write_number(std::uint32_t number, std::byte* to) {
    for (; number >= 0x80; number >>= 7) *to++ = std::byte(number | 0x80);
    *to++ = std::byte(number);
    return to;
}
std::uint32_t read_number(const std::byte*& from) {
    std::uint32_t number = 0;
    for (int shift = 0;; shift += 7) {
        const auto byte = std::to_integer<std::uint32_t>(*from++);
        number |= (byte & 0x7f) << shift;
        if (byte < 0x80) return number;
    }
}

// Returns the largest colour (not associated) of the pixels in `runs`, at least 1.
float largest_color(const Image& picture, const ActiveRuns& runs, const RowSpan& rows) {
    float largest = 1;
    for (int row = rows.first; row < rows.end; ++row) {
        for (const ActiveRuns::Run* run = runs.begin(row); run != runs.end(row); ++run) {
            const float* pixel = picture.pixel(run->first, row);
            for (int column = run->first; column < run->end; ++column, pixel += 4) {
                const float color = std::max({pixel[0], pixel[1], pixel[2]});
                if (color > largest * pixel[3] && pixel[3] > 0) largest = color / pixel[3];
            }
        }
    }
    return largest;
}

// Encodes the runs of a row, as encode_rows() says. A run of length 0 ends the row.
template <typename Format>
std::byte* encode_row(const Image& picture, const ActiveRuns& runs, int row, float largest,
                      std::byte* to) {
    int before = 0;
    for (const ActiveRuns::Run* run = runs.begin(row); run != runs.end(row); ++run) {
        to = write_number(static_cast<std::uint32_t>(run->end - run->first), to);
        to = write_number(static_cast<std::uint32_t>(run->first - before), to);
        before = run->end;
        const float* pixel = picture.pixel(run->first, row);
        for (int column = run->first; column < run->end; ++column, pixel += 4, to += Format::size)
            Format::encode(pixel, largest, to);
    }
    return write_number(0, to);
}

// Decodes a row and composites it behind `row`. Returns the end of its bytes.
template <typename Format>
const std::byte* put_row_behind(const std::byte* from, float largest, float* row) {
    for (std::uint32_t count = read_number(from); count > 0; count = read_number(from)) {
        row += 4 * static_cast<std::size_t>(read_number(from));
        for (; count > 0; --count, from += Format::size, row += 4)
            put_behind(Format::decode(from, largest), row);
    }
    return from;
}

}  // namespace

const char* name_of(Wire wire) {
    return word_of(wire, {"float32", "half", "coded"});
}

Wire wire_of(const std::string& word) {
    if (const auto found = value_of_word<Wire>(word)) return *found;
    throw UsageError(
        fmt::format("--wire: found {}, expected {}", shortened(word), alternatives<Wire>()));
}

std::vector<RowSpan> divide_rows(const std::vector<std::int64_t>& weights, const RowSpan& rows,
                                 int count) {
    std::int64_t all = 0;
    for (int row = rows.first; row < rows.end; ++row) all += weights[static_cast<std::size_t>(row)];
    std::vector<RowSpan> spans;
    std::int64_t sum = 0;
    int row = rows.first;
    for (int i = 0; i < count; ++i) {
        RowSpan span{row, row};
        // A row belongs to the span in which the middle of its range of the summed weights lies.
        const auto ends_in = [&](std::int64_t weight) {
            return i + 1 == count || (2 * sum + weight) * count < 2 * all * (i + 1);
        };
        while (row < rows.end && ends_in(weights[static_cast<std::size_t>(row)]))
            sum += weights[static_cast<std::size_t>(row++)];
        span.end = row;
        spans.push_back(span);
    }
    return spans;
}

ActiveRuns::ActiveRuns(const Image& picture, const RowSpan& rows) : first_row_(rows.first) {
    starts_.push_back(0);
    for (int row = rows.first; row < rows.end; ++row) {
        const float* const pixels = picture.pixel(0, row);
        for (int end = 0;;) {
            const int first = first_shown(pixels, end, picture.width);
            if (first == picture.width) break;
            end = first_hidden(pixels, first, picture.width);
            runs_.push_back({first, end});
        }
        starts_.push_back(runs_.size());
    }
}

std::int64_t ActiveRuns::pixels(int row) const {
    std::int64_t sum = 0;
    for (const Run* run = begin(row); run != end(row); ++run) sum += run->end - run->first;
    return sum;
}

void encode_rows(const Image& picture, const ActiveRuns& runs, const RowSpan& rows,
                 FragmentFormat format, std::vector<std::byte>& bytes) {
    with_format(format, [&](auto chosen) {
        using Format = decltype(chosen);
        const float largest = Format::has_codes ? largest_color(picture, runs, rows) : 1;
        std::size_t most = sizeof largest;
        for (int row = rows.first; row < rows.end; ++row) {
            const auto count = static_cast<std::size_t>(runs.end(row) - runs.begin(row));
            most += static_cast<std::size_t>(runs.pixels(row)) * Format::size +
                    2 * most_number_bytes * count + 1;
        }
        bytes.resize(most);
        std::memcpy(bytes.data(), &largest, sizeof largest);
        std::byte* to = bytes.data() + sizeof largest;
        for (int row = rows.first; row < rows.end; ++row)
            to = encode_row<Format>(picture, runs, row, largest, to);
        bytes.resize(static_cast<std::size_t>(to - bytes.data()));
    });
}

void put_rows_behind(const std::vector<std::byte>& bytes, const RowSpan& rows,
                     FragmentFormat format, Image& front) {
    with_format(format, [&](auto chosen) {
        float largest;
        std::memcpy(&largest, bytes.data(), sizeof largest);
        const std::byte* from = bytes.data() + sizeof largest;
        for (int row = rows.first; row < rows.end; ++row)
            from = put_row_behind<decltype(chosen)>(from, largest, front.pixel(0, row));
        assert(from == bytes.data() + bytes.size());
    });
}

void put_rows_behind(const Image& picture, const ActiveRuns& runs, const RowSpan& rows,
                     Image& front) {
    for (int row = rows.first; row < rows.end; ++row) {
        for (const ActiveRuns::Run* run = runs.begin(row); run != runs.end(row); ++run) {
            const float* behind = picture.pixel(run->first, row);
            float* there = front.pixel(run->first, row);
            for (int column = run->first; column < run->end; ++column, behind += 4, there += 4)
                put_behind({behind[0], behind[1], behind[2], behind[3]}, there);
        }
    }
}

}  // namespace lamina
