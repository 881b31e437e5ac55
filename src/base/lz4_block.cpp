// SPDX-License-Identifier: Apache-2.0
#include "base/lz4_block.h"

#include <algorithm>

namespace lamina {
namespace {

// A length of 15 in the token goes on in the bytes behind it, up to the first below 255.
bool read_length(std::span<const char>& block, std::size_t& length) {
    if (length < 15) return true;
    for (unsigned char more = 255; more == 255;) {
        if (block.empty()) return false;
        more = static_cast<unsigned char>(block.front());
        block = block.subspan(1);
        length += more;
    }
    return true;
}

}  // namespace

bool decode_lz4_block(std::span<const char> block, std::span<char> output) {
    constexpr std::size_t least_match = 4;
    std::size_t done = 0;
    while (!block.empty()) {
        const auto token = static_cast<unsigned char>(block.front());
        block = block.subspan(1);
        std::size_t literals = token >> 4;
        if (!read_length(block, literals)) return false;
        if (literals > block.size() || literals > output.size() - done) return false;
        std::copy_n(block.begin(), literals, output.begin() + static_cast<std::ptrdiff_t>(done));
        done += literals;
        block = block.subspan(literals);
        if (block.empty()) break;  // the last sequence has no match
        if (block.size() < 2) return false;
        const std::size_t distance = static_cast<unsigned char>(block[0]) |
                                     static_cast<std::size_t>(static_cast<unsigned char>(block[1]))
                                         << 8;
        block = block.subspan(2);
        std::size_t match = token & 15;
        if (!read_length(block, match)) return false;
        match += least_match;
        if (distance == 0 || distance > done || match > output.size() - done) return false;
        // The match may go on into what it writes.
        for (; match > 0; --match, ++done) output[done] = output[done - distance];
    }
    return done == output.size();
}

}  // namespace lamina
