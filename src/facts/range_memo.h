// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "volume/min_max_bricks.h"

namespace lamina {

// Remembers answers about ranges of bricks. Samples of 8 bits have few different ranges, and holes
// of any type have one.
template <typename Answer>
class RangeMemo {
  public:
    // compute(range), or what it was for the same range before.
    template <typename Compute>
    Answer get(const BrickRange& range, const Compute& compute) {
        const auto bits = [](float value) {
            return std::uint64_t{std::bit_cast<std::uint32_t>(value)};
        };
        const std::uint64_t mixed =
            (bits(range.lo) << 32 | bits(range.hi)) * 0x9e3779b97f4a7c15u;  // 2^64 / golden ratio
        Entry& entry = entries_[mixed >> (64 - address_bits)];
        if (entry.range.lo != range.lo || entry.range.hi != range.hi)
            entry = {range, compute(ValueRange{range.lo, range.hi})};
        return entry.answer;
    }

  private:
    static constexpr int address_bits = 12;

    struct Entry {
        BrickRange range{std::numeric_limits<float>::quiet_NaN(), 0};  // equal to no other
        Answer answer{};
    };
    std::vector<Entry> entries_ = std::vector<Entry>(std::size_t{1} << address_bits);
};

}  // namespace lamina
