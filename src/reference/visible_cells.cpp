// SPDX-License-Identifier: Apache-2.0
#include "reference/visible_cells.h"

#include <algorithm>
#include <array>
#include <type_traits>

#include "base/parallel.h"

namespace lamina {
namespace {

// The least and the greatest samples at the corners of a block's cells. A cell with a sample that
// is no number has any of them: it is transparent.
template <typename Sample>
class BlockRanges {
  public:
    static constexpr std::size_t edge = VisibleCells::edge;

    BlockRanges(const Sample* samples, const std::array<std::int64_t, 3>& size,
                const std::array<std::int64_t, 3>& first) {
        for (std::size_t z = 0; z <= edge; ++z) {
            const std::int64_t slice = clamped(first[2], z, size[2]) * size[1];
            for (std::size_t y = 0; y <= edge; ++y) {
                const Sample* const row =
                    samples + (slice + clamped(first[1], y, size[1])) * size[0];
                Sample values[edge + 1];
                for (std::size_t x = 0; x <= edge; ++x)
                    values[x] = row[clamped(first[0], x, size[0])];
                for (std::size_t x = 0; x < edge; ++x) {
                    least_[z][y][x] = lesser(values[x], values[x + 1]);
                    most_[z][y][x] = greater(values[x], values[x + 1]);
                }
            }
        }
        for (std::size_t z = 0; z <= edge; ++z) {
            for (std::size_t y = 0; y < edge; ++y) join(z, y, z, y + 1);
        }
        for (std::size_t z = 0; z < edge; ++z) {
            for (std::size_t y = 0; y < edge; ++y) join(z, y, z + 1, y);
        }
    }

    // The bits of a row of cells: 1 where a cell may show something.
    std::uint8_t visible(std::size_t y, std::size_t z, const TransferIntervals& transfer) const {
        unsigned bits = 0;
        for (std::size_t x = 0; x < edge; ++x) {
            const bool seen = transfer.visible(static_cast<double>(least_[z][y][x]),
                                               static_cast<double>(most_[z][y][x]));
            bits |= unsigned{seen} << x;
        }
        return static_cast<std::uint8_t>(bits);
    }

  private:
    static Sample lesser(Sample a, Sample b) { return b < a ? b : a; }
    static Sample greater(Sample a, Sample b) { return a < b ? b : a; }
    static std::int64_t clamped(std::int64_t first, std::size_t step, std::int64_t size) {
        return std::min(first + static_cast<std::int64_t>(step), size - 1);
    }
    void join(std::size_t z, std::size_t y, std::size_t other_z, std::size_t other_y) {
        for (std::size_t x = 0; x < edge; ++x) {
            least_[z][y][x] = lesser(least_[z][y][x], least_[other_z][other_y][x]);
            most_[z][y][x] = greater(most_[z][y][x], most_[other_z][other_y][x]);
        }
    }

    Sample least_[edge + 1][edge + 1][edge], most_[edge + 1][edge + 1][edge];
};

}  // namespace

std::array<std::int64_t, 3> VisibleCells::blocks_of(const Grid& grid) {
    std::array<std::int64_t, 3> blocks;
    for (std::size_t axis = 0; axis < 3; ++axis) blocks[axis] = (grid.size[axis] - 1) / edge + 1;
    return blocks;
}

std::uint64_t VisibleCells::bytes_for(const Grid& grid) {
    const auto [x, y, z] = blocks_of(grid);
    return static_cast<std::uint64_t>(x * y * z) * (rows_of_block + 1);
}

VisibleCells::VisibleCells(const Volume& volume, const TransferIntervals& transfer) {
    const std::array<std::int64_t, 3>& size = volume.grid().size;
    count_ = blocks_of(volume.grid());
    any_.resize(static_cast<std::size_t>(count_[0] * count_[1] * count_[2]));
    rows_.resize(any_.size() * rows_of_block);
    volume.visit([&](const auto* samples) {
        using Sample = std::remove_cvref_t<decltype(*samples)>;
        parallel_for(count_[1] * count_[2], 1, [&](std::int64_t line) {
            const std::int64_t y = line % count_[1], z = line / count_[1];
            for (std::int64_t x = 0; x < count_[0]; ++x) {
                const BlockRanges<Sample> ranges(samples, size, {x * edge, y * edge, z * edge});
                const std::size_t block = place_of({x, y, z});
                for (std::size_t row = 0; row < rows_of_block; ++row) {
                    const std::uint8_t bits = ranges.visible(row % edge, row / edge, transfer);
                    rows_[block * rows_of_block + row] = bits;
                    any_[block] |= bits;
                }
            }
        });
    });
}

}  // namespace lamina
