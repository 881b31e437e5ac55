// SPDX-License-Identifier: Apache-2.0
#include "choice/shown_cells.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/geometric.hpp>
#include <memory>
#include <utility>

#include "base/parallel.h"
#include "choice/field.h"
#include "volume/range_answers.h"
#include "volume/sample_source.h"
#include "volume/volume_store.h"

namespace lamina {

namespace {

using Shows = std::function<bool(const ValueRange&)>;

constexpr std::int64_t edge = MinMaxBricks::edge;

// The cells first .. last - 1 of a row, that is, those between two planes. Empty if first > last.
struct Span {
    std::int64_t first = INT64_MAX, last = -1;
    void include(const Span& span) {
        first = std::min(first, span.first);
        last = std::max(last, span.last);
    }
    bool empty() const { return first > last; }
};

// Returns the number of cells along each axis; a single sample counts as one cell.
std::array<std::int64_t, 3> cells_of(const Grid& grid) {
    std::array<std::int64_t, 3> cells;
    for (std::size_t axis = 0; axis < 3; ++axis)
        cells[axis] = std::max<std::int64_t>(1, grid.size[axis] - 1);
    return cells;
}

// Calls visit(x) for visible bricks along x, and shows() once for neighbours of equal range.
template <typename Visit>
void for_shown_bricks(const MinMaxBricks& bricks, std::int64_t y, std::int64_t z,
                      const Shows& shows, const Visit& visit) {
    ValueRange before;
    bool shown = false;
    for (std::int64_t x = 0; x < bricks.count[0]; ++x) {
        const ValueRange range = bricks.at(x, y, z);
        if (range != before) shown = !range.empty() && shows(range);
        before = range;
        if (shown) visit(x);
    }
}

// One row of cells along x. `window` must hold the samples of the cells.
template <typename T>
class CellRow {
  public:
    CellRow(const Grid& grid, const SampleWindow<T>& window, std::int64_t y, std::int64_t z)
        : first_(window.box.first[0]), last_(grid.size[0] - 1) {
        for (std::size_t i = 0; i < 4; ++i) {
            const std::int64_t at_y = std::min(y + std::int64_t(i % 2), grid.size[1] - 1);
            const std::int64_t at_z = std::min(z + std::int64_t(i / 2), grid.size[2] - 1);
            lines_[i] = window.row(at_y, at_z);
        }
    }

    ValueRange range(std::int64_t x) const {
        ValueRange range;
        for (const T* line : lines_) {
            for (const std::int64_t at : {x, std::min(x + 1, last_)}) {
                const double value = static_cast<double>(line[at - first_]);
                if (!std::isfinite(value)) continue;
                range = range.empty()
                            ? ValueRange{value, value}
                            : ValueRange{std::min(range.lo, value), std::max(range.hi, value)};
            }
        }
        return range;
    }

  private:
    std::int64_t first_, last_;
    std::array<const T*, 4> lines_;
};

// Finds the first and the last visible cell of a row among the cells `among`: it searches the row's
// bricks from both ends.
template <typename T>
Span shown_of_row(const CellRow<T>& row, const Span& among,
                  const std::vector<std::int64_t>& shown_bricks, const Shows& shows) {
    const auto shown = [&](std::int64_t x) {
        const ValueRange range = row.range(x);
        return !range.empty() && shows(range);
    };
    Span span;
    for (auto brick = shown_bricks.begin(); brick != shown_bricks.end() && span.empty(); ++brick) {
        const std::int64_t end = std::min(among.last, (*brick + 1) * edge);
        for (std::int64_t x = std::max(among.first, *brick * edge); x < end && span.empty(); ++x)
            if (shown(x)) span = {x, x + 1};
    }
    if (span.empty()) return span;
    for (auto brick = shown_bricks.rbegin();; ++brick) {
        for (std::int64_t x = std::min(among.last, (*brick + 1) * edge) - 1; x >= *brick * edge;
             --x) {
            if (x < span.last || shown(x)) return {span.first, std::max(span.last, x + 1)};
        }
    }
}

// Finds the first and the last visible cell of all rows along x, in blocks of rows of bricks. If
// the volume stays in its files, the samples of a block are read at once.
template <typename T>
struct RowSpans {
    const Volume& volume;
    const MinMaxBricks& bricks;
    const Shows& shows;
    const SampleBox inside;
    const Grid& grid = volume.grid();
    std::array<std::int64_t, 3> cells = cells_of(grid);
    std::array<Span, 3> among = inner_cells();
    std::vector<Span> spans = std::vector<Span>(static_cast<std::size_t>(cells[1] * cells[2]));

    // Returns one span for each row of cells along x, y fastest.
    std::vector<Span> find() {
        const std::int64_t along = blocks(1);
        parallel_for(along * blocks(2), 1, [&](std::int64_t block) {
            find_in_block(block % along * block_edge, block / along * block_edge);
        });
        return std::move(spans);
    }

    static constexpr std::int64_t block_edge = 8;  // bricks

    // Returns the cells between the samples inside; along an axis with one sample, its cell.
    std::array<Span, 3> inner_cells() const {
        std::array<Span, 3> found;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::int64_t first = inside.first[axis];
            found[axis] = {first, first + std::max<std::int64_t>(1, inside.size[axis] - 1)};
        }
        return found;
    }

    struct BrickRow {
        std::int64_t y, z;
        std::vector<std::int64_t> shown;  // numbers along x of the visible bricks
    };

    std::int64_t blocks(std::size_t axis) const {
        return (bricks.count[axis] + block_edge - 1) / block_edge;
    }

    void find_in_block(std::int64_t first_y, std::int64_t first_z) {
        std::vector<BrickRow> rows;
        Span columns;
        for (std::int64_t z = first_z; z < std::min(first_z + block_edge, bricks.count[2]); ++z) {
            for (std::int64_t y = first_y; y < std::min(first_y + block_edge, bricks.count[1]);
                 ++y) {
                BrickRow row{y, z, {}};
                for_shown_bricks(bricks, y, z, shows,
                                 [&](std::int64_t x) { row.shown.push_back(x); });
                if (row.shown.empty()) continue;
                columns.include({row.shown.front(), row.shown.back() + 1});
                rows.push_back(std::move(row));
            }
        }
        if (rows.empty()) return;
        std::unique_ptr<T[]> samples;
        const SampleWindow<T> window = window_of(columns, first_y, first_z, samples);
        for (const BrickRow& row : rows) find_in_row(row, window);
    }

    // Returns a block's samples in the bricks `columns`; `samples` receives those from files.
    SampleWindow<T> window_of(const Span& columns, std::int64_t first_y, std::int64_t first_z,
                              std::unique_ptr<T[]>& samples) const {
        if (volume.in_memory())
            return {{{0, 0, 0}, grid.size}, static_cast<const T*>(volume.data())};
        const std::array<std::int64_t, 3> first{columns.first, first_y, first_z};
        const std::array<std::int64_t, 3> end{columns.last, first_y + block_edge,
                                              first_z + block_edge};
        SampleBox box;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            box.first[axis] = first[axis] * edge;
            box.size[axis] = std::min(end[axis] * edge + 1, grid.size[axis]) - box.first[axis];
        }
        samples = std::make_unique_for_overwrite<T[]>(static_cast<std::size_t>(box.count()));
        volume.store().source().read(box, samples.get());
        return {box, samples.get()};
    }

    void find_in_row(const BrickRow& row, const SampleWindow<T>& window) {
        const auto part = [](std::int64_t brick, const Span& within) {
            return Span{std::max(within.first, brick * edge),
                        std::min(within.last, (brick + 1) * edge)};
        };
        const Span of_y = part(row.y, among[1]), of_z = part(row.z, among[2]);
        for (std::int64_t z = of_z.first; z < of_z.last; ++z) {
            for (std::int64_t y = of_y.first; y < of_y.last; ++y)
                spans[static_cast<std::size_t>(z * cells[1] + y)] =
                    shown_of_row(CellRow<T>(grid, window, y, z), among[0], row.shown, shows);
        }
    }
};

// Returns the index-space coordinate of the plane between cells `plane - 1` and `plane`.
double plane_at(const Grid& grid, int axis, std::int64_t plane, std::int64_t cells) {
    if (plane == 0) return grid.index_min()[axis];
    if (plane == cells) return grid.index_max()[axis];
    return static_cast<double>(plane);
}

// Returns the outer corners of the first and the last visible brick of each row along x.
std::vector<glm::dvec3> hull_of_shown_bricks(const Grid& grid, const MinMaxBricks& bricks,
                                             const Shows& shows) {
    const auto cells = cells_of(grid);
    const auto place = [&](int axis, std::int64_t brick) {
        const std::int64_t count = cells[static_cast<std::size_t>(axis)];
        return plane_at(grid, axis, std::min(brick * edge, count), count);
    };
    const RangeAnswers<std::uint8_t> shown(bricks.ranges, [&](const ValueRange& range) {
        return std::uint8_t{!range.empty() && shows(range)};
    });
    std::vector<std::vector<glm::dvec3>> of_slices(static_cast<std::size_t>(bricks.count[2]));
    parallel_for(bricks.count[2], 1, [&](std::int64_t z) {
        RangeAnswers<std::uint8_t>::Reader is_shown(shown);
        std::vector<std::uint8_t> of_row(static_cast<std::size_t>(bricks.count[0]));
        for (std::int64_t y = 0; y < bricks.count[1]; ++y) {
            is_shown.fill(static_cast<std::size_t>(z * bricks.count[1] + y) * of_row.size(),
                          of_row);
            const auto first = std::ranges::find(of_row, std::uint8_t{1});
            if (first == of_row.end()) continue;
            const auto last = std::find(of_row.rbegin(), of_row.rend(), std::uint8_t{1}).base();
            const Span row{first - of_row.begin(), last - of_row.begin()};
            for (int corner = 0; corner < 8; ++corner) {
                of_slices[static_cast<std::size_t>(z)].push_back(
                    grid.to_world({place(0, (corner & 1) != 0 ? row.last : row.first),
                                   place(1, y + (corner >> 1 & 1)), place(2, z + (corner >> 2))}));
            }
        }
    });
    std::vector<glm::dvec3> points;
    for (const auto& slice : of_slices) points.insert(points.end(), slice.begin(), slice.end());
    return points;
}

}  // namespace

std::vector<glm::dvec3> hull_of_shown_cells(const Volume& volume, const MinMaxBricks& bricks,
                                            const Shows& shows,
                                            const std::optional<SampleBox>& inside) {
    const Grid& grid = volume.grid();
    if (grid.sample_count() > large_volume) return hull_of_shown_bricks(grid, bricks, shows);
    const auto cells = cells_of(grid);
    const std::vector<Span> rows = with_sample_type(volume.type(), [&](auto zero) {
        return RowSpans<decltype(zero)>{volume, bricks, shows,
                                        inside.value_or(SampleBox{{0, 0, 0}, grid.size})}
            .find();
    });
    // Up to four rows of cells touch a line of edges along x, which takes the union of their spans.
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
