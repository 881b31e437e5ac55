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
    // as a block.
    const std::size_t lines_a_part =
        std::max<std::size_t>(1, (bytes + most_bytes - 1) / most_bytes);
    const std::size_t block = sample_parts * lines_a_part;
    Words state{};
    for (std::size_t first = 0; first * line_bytes < bytes; first += block) {
        const std::uint64_t place = (first / block + 1) * 0x9e3779b97f4a7c15u >> 32;
        const std::size_t at = (first + (part * lines_a_part + place) % block) * line_bytes;
        if (at < bytes) add(samples + at, std::min(line_bytes, bytes - at), state);
    }
    std::uint64_t hash = bytes;
    for (const std::uint64_t word : state)
        hash = std::rotl((hash ^ word) * 0x9e3779b97f4a7c15u, 31);
    return hash;
}

}  // namespace lamina::python
