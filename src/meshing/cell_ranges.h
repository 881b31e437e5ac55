// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "meshing/trilinear_field.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// The range of a field over blocks of 2^level cells along each axis, from level 1 up to the level
// with one block.
class CellRanges {
  public:
    explicit CellRanges(const TrilinearField& field);  // parallel; a quarter of the field's memory

    int levels() const { return static_cast<int>(levels_.size()); }
    ValueRange of_block(int level, const TrilinearField::Cell& block) const {
        const Level& blocks = levels_[static_cast<std::size_t>(level - 1)];
        const auto [lo, hi] = blocks.ranges[blocks.offset(block)];
        return {lo, hi};
    }

  private:
    struct Range {
        float lo, hi;
    };
    struct Level {
        std::array<std::int64_t, 3> count{1, 1, 1};
        std::vector<Range> ranges;  // x fastest
        std::size_t offset(const TrilinearField::Cell& block) const {
            return static_cast<std::size_t>((block[2] * count[1] + block[1]) * count[0] + block[0]);
        }
    };

    template <typename RangeOf>
    void add_level(std::array<std::int64_t, 3> count, const RangeOf& range_of);
    std::vector<Level> levels_;
};

}  // namespace lamina
