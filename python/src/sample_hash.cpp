// SPDX-License-Identifier: Apache-2.0
#include "sample_hash.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace lamina::python {
namespace {

constexpr std::size_t line_bytes = 64;         // a cache line
constexpr std::size_t most_bytes = 64u << 20;  // all parts together read at most as many
constexpr std::size_t small_bytes = 1u << 16;  // up to here each part reads all, in microseconds
// Lines that are prefetched: as many as memory fetches side by side.
constexpr std::size_t lines_ahead = 16;

static_assert(std::has_single_bit(sample_parts));

using Words = std::array<std::uint64_t, line_bytes / sizeof(std::uint64_t)>;

// Multiplies and rotates eight words of 64 bits side by side. The state depends on all lines
// before, so their order counts. The factor is that of FNV-1a.
void add(const char* from, std::size_t count, Words& state) {
    Words line{};
    std::memcpy(line.data(), from, count);
    for (std::size_t i = 0; i < line.size(); ++i)
        state[i] = std::rotl((state[i] ^ line[i]) * 0x100000001b3u, 29);
}

}  // namespace

std::uint64_t hash_of_part(const char* samples, std::size_t bytes, std::size_t part) {
    // A part reads one line of each block, at a place that changes from block to block: at a fixed
    // place it would read one column alone if rows of samples are as long as blocks. Of
    // `lines_a_part` lines that fall to a part in a block it reads one.
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
