// SPDX-License-Identifier: Apache-2.0
#include "choice/shown_cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "base/parallel.h"
#include "volume/sample_access.h"

namespace lamina {
namespace {

using Shows = std::function<bool(const ValueRange&)>;

constexpr std::int64_t edge = MinMaxBricks::edge;

// From the near side of the first cell to the far side of the last; first > last: none.
struct Span {
    std::int64_t first = INT64_MAX, last = -1;
    void include(const Span& span) {
        first = std::min(first, span.first);
        last = std::max(last, span.last);
    }
    bool empty() const { return first > last; }
};

std::array<std::int64_t, 3> cells_of(const Grid& grid) {
    std::array<std::int64_t, 3> cells;
    for (std::size_t axis = 0; axis < 3; ++axis)
        cells[axis] = std::max<std::int64_t>(1, grid.size[axis] - 1);
    return cells;
}

// The cells of one row along x.
template <typename Samples>
class CellRow {
  public:
    CellRow(const Grid& grid, const Samples& samples, std::int64_t y, std::int64_t z)
        : size_(grid.size[0]) {
        const auto [nx, ny, nz] = grid.size;
        for (std::size_t i = 0; i < 4; ++i) {
            const std::int64_t at_y = std::min(y + std::int64_t(i % 2), ny - 1);
            const std::int64_t at_z = std::min(z + std::int64_t(i / 2), nz - 1);
            lines_[i] = samples + (at_z * ny + at_y) * nx;
        }
    }

    ValueRange range(std::int64_t x) const {
        ValueRange range;
        for (const Samples& line : lines_) {
            for (const std::int64_t at : {x, std::min(x + 1, size_ - 1)}) {
                const double value = static_cast<double>(line[at]);
                if (!std::isfinite(value)) continue;
                range = range.empty()
                            ? ValueRange{value, value}
                            : ValueRange{std::min(range.lo, value), std::max(range.hi, value)};
            }
        }
        return range;
    }

  private:
    std::int64_t size_;
    std::array<Samples, 4> lines_;
};

// Looks into bricks that show something alone, from both ends.
template <typename Samples>
Span shown_of_row(const CellRow<Samples>& row, std::int64_t cells,
                  const std::vector<std::int64_t>& shown_bricks, const Shows& shows) {
    const auto shown = [&](std::int64_t x) {
        const ValueRange range = row.range(x);
        return !range.empty() && shows(range);
    };
    Span span;
    for (auto brick = shown_bricks.begin(); brick != shown_bricks.end() && span.empty(); ++brick) {
        const std::int64_t end = std::min(cells, (*brick + 1) * edge);
        for (std::int64_t x = *brick * edge; x < end && span.empty(); ++x)
            if (shown(x)) span = {x, x + 1};
    }
    if (span.empty()) return span;
    for (auto brick = shown_bricks.rbegin();; ++brick) {
        for (std::int64_t x = std::min(cells, (*brick + 1) * edge) - 1; x >= *brick * edge; --x) {
            if (x < span.last || shown(x)) return {span.first, std::max(span.last, x + 1)};
        }
    }
}

// For each row of cells along x, y fastest.
template <typename Samples>
std::vector<Span> shown_of_rows(const Grid& grid, const Samples& samples,
                                const MinMaxBricks& bricks, const Shows& shows) {
    const auto cells = cells_of(grid);
    std::vector<Span> spans(static_cast<std::size_t>(cells[1] * cells[2]));
    parallel_for(bricks.count[1] * bricks.count[2], 4, [&](std::int64_t brick_row) {
        const std::int64_t by = brick_row % bricks.count[1], bz = brick_row / bricks.count[1];
        std::vector<std::int64_t> shown_bricks;
        for (std::int64_t bx = 0; bx < bricks.count[0]; ++bx) {
            const ValueRange range = bricks.at(bx, by, bz);
            if (!range.empty() && shows(range)) shown_bricks.push_back(bx);
        }
        for (std::int64_t z = bz * edge; z < std::min(cells[2], (bz + 1) * edge); ++z) {
            for (std::int64_t y = by * edge; y < std::min(cells[1], (by + 1) * edge); ++y)
                spans[static_cast<std::size_t>(z * cells[1] + y)] = shown_of_row(
                    CellRow<Samples>(grid, samples, y, z), cells[0], shown_bricks, shows);
        }
    });
    return spans;
}

// The index of the plane between cells number `plane - 1` and `plane` along an axis.
double plane_at(const Grid& grid, int axis, std::int64_t plane, std::int64_t cells) {
    if (plane == 0) return grid.index_min()[axis];
    if (plane == cells) return grid.index_max()[axis];
    return static_cast<double>(plane);
}

}  // namespace

std::vector<glm::dvec3> hull_of_shown_cells(const Volume& volume, const MinMaxBricks& bricks,
                                            const Shows& shows) {
    const Grid& grid = volume.grid();
    const auto cells = cells_of(grid);
    const std::vector<Span> rows = visit_samples(
        volume, [&](const auto& samples) { return shown_of_rows(grid, samples, bricks, shows); });
    // A line of cells' edges lies between up to four rows.
    const std::int64_t lines_y = cells[1] + 1;
    std::vector<Span> lines(static_cast<std::size_t>(lines_y * (cells[2] + 1)));
    for (std::int64_t row = 0; row < cells[1] * cells[2]; ++row) {
        const std::int64_t corner = row / cells[1] * lines_y + row % cells[1];
        for (const std::int64_t line : {corner, corner + 1, corner + lines_y, corner + lines_y + 1})
            lines[static_cast<std::size_t>(line)].include(rows[static_cast<std::size_t>(row)]);
    }
    std::vector<glm::dvec3> points;
    for (std::size_t line = 0; line < lines.size(); ++line) {
        if (lines[line].empty()) continue;
        const double y = plane_at(grid, 1, static_cast<std::int64_t>(line) % lines_y, cells[1]);
        const double z = plane_at(grid, 2, static_cast<std::int64_t>(line) / lines_y, cells[2]);
        for (const std::int64_t plane : {lines[line].first, lines[line].last})
            points.push_back(grid.to_world({plane_at(grid, 0, plane, cells[0]), y, z}));
    }
    return points;
}

}  // namespace lamina
