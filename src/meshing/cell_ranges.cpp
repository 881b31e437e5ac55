// SPDX-License-Identifier: Apache-2.0
#include "meshing/cell_ranges.h"

#include <algorithm>
#include <limits>

#include "base/parallel.h"

namespace lamina {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

std::array<std::int64_t, 3> half_of(const std::array<std::int64_t, 3>& count) {
    return {(count[0] + 1) / 2, (count[1] + 1) / 2, (count[2] + 1) / 2};
}

// Calls visit(x, y, z) for all first[i] <= (x, y, z)[i] <= last[i].
template <typename Visit>
void for_each(const TrilinearField::Cell& first, const TrilinearField::Cell& last,
              const Visit& visit) {
    for (std::int32_t z = first[2]; z <= last[2]; ++z) {
        for (std::int32_t y = first[1]; y <= last[1]; ++y) {
            for (std::int32_t x = first[0]; x <= last[0]; ++x) {
                visit(TrilinearField::Cell{x, y, z});
            }
        }
    }
}

}  // namespace

template <typename RangeOf>
void CellRanges::add_level(std::array<std::int64_t, 3> count, const RangeOf& range_of) {
    Level level{count, {}};
    level.ranges.resize(static_cast<std::size_t>(count[0] * count[1] * count[2]));
    parallel_for(count[1] * count[2], 16, [&](std::int64_t row) {
        for (std::int64_t x = 0; x < count[0]; ++x) {
            const TrilinearField::Cell block{static_cast<std::int32_t>(x),
                                             static_cast<std::int32_t>(row % count[1]),
                                             static_cast<std::int32_t>(row / count[1])};
            level.ranges[level.offset(block)] = range_of(block);
        }
    });
    levels_.push_back(std::move(level));
}

CellRanges::CellRanges(const TrilinearField& field) {
    std::array<std::int64_t, 3> count{field.cell_count(0), field.cell_count(1),
                                      field.cell_count(2)};
    // A block covers its cells and both planes around them.
    const auto range_of_planes = [&](const TrilinearField::Cell& block) {
        TrilinearField::Cell first{}, last{};
        for (int axis = 0; axis < 3; ++axis) {
            first[axis] = 2 * block[axis];
            last[axis] = std::min(2 * block[axis] + 2, field.cell_count(axis));
        }
        Range range{infinity, -infinity};
        for_each(first, last, [&](const TrilinearField::Cell& plane) {
            const auto value = static_cast<float>(field.at_plane(plane));
            range = {std::min(range.lo, value), std::max(range.hi, value)};
        });
        return range;
    };
    count = half_of(count);
    add_level(count, range_of_planes);

    while (count[0] > 1 || count[1] > 1 || count[2] > 1) {
        const std::size_t below = levels_.size() - 1;
        const auto range_of_children = [&](const TrilinearField::Cell& block) {
            const Level& children = levels_[below];
            TrilinearField::Cell first{}, last{};
            for (int axis = 0; axis < 3; ++axis) {
                first[axis] = 2 * block[axis];
                last[axis] = static_cast<std::int32_t>(
                    std::min<std::int64_t>(first[axis] + 1, children.count[axis] - 1));
            }
            Range range{infinity, -infinity};
            for_each(first, last, [&](const TrilinearField::Cell& child) {
                const Range& part = children.ranges[children.offset(child)];
                range = {std::min(range.lo, part.lo), std::max(range.hi, part.hi)};
            });
            return range;
        };
        count = half_of(count);
        add_level(count, range_of_children);
    }
}

}  // namespace lamina
