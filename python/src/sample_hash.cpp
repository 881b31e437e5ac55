// SPDX-License-Identifier: Apache-2.0
#include "sample_hash.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace lamina::python {
namespace {

constexpr std::size_t line_bytes = 64;         // what memory gives at a time
constexpr std::size_t most_bytes = 64u << 20;  // that all parts have together
constexpr std::size_t small_bytes = 1u << 16;  // of which each part has all, in a few microseconds
// Lines that are asked for before they are needed: as many as memory fetches side by side.
constexpr std::size_t lines_ahead = 16;

static_assert(std::has_single_bit(sample_parts));

using Words = std::array<std::uint64_t, line_bytes / sizeof(std::uint64_t)>;

// FNV-1a over words of 64 bits, eight side by side: a line is at another place only in another
// state.
void add(const char* from, std::size_t count, Words& state) {
    Words line{};
    std::memcpy(line.data(), from, count);
    for (std::size_t i = 0; i < line.size(); ++i)
        state[i] = std::rotl((state[i] ^ line[i]) * 0x100000001b3u, 29);
}

}  // namespace

std::uint64_t hash_of_part(const char* samples, std::size_t bytes, std::size_t part) {
    // A part has one line of each block, at another place in each: rows of samples may be as long
    // as a block, whose lines are a power of two.
    const std::size_t lines_a_part = std::bit_ceil((bytes + most_bytes - 1) / most_bytes);
    const std::size_t block = bytes <= small_bytes ? 1 : sample_parts * lines_a_part;
    const auto place_in = [&](std::size_t number) {
        const std::uint64_t place = (number + 1) * 0x9e3779b97f4a7c15u >> 32;
        return (number * block + ((part * lines_a_part + place) & (block - 1))) * line_bytes;
    };
    const std::size_t blocks = (bytes + block * line_bytes - 1) / (block * line_bytes);
    Words state{};
    for (std::size_t i = 0; i < blocks; ++i) {
        const std::size_t soon = place_in(i + lines_ahead), at = place_in(i);
        if (soon < bytes) __builtin_prefetch(samples + soon);
        if (at < bytes) add(samples + at, std::min(line_bytes, bytes - at), state);
    }
    std::uint64_t hash = bytes;
    for (const std::uint64_t word : state)
        hash = std::rotl((hash ^ word) * 0x9e3779b97f4a7c15u, 31);
    return hash;
}

}  // namespace lamina::python
