// SPDX-License-Identifier: Apache-2.0
#include "reference/cells.h"

#include <bit>
#include <cstring>

#include "base/parallel.h"

#undef LAMINA_TARGET_FILE
#define LAMINA_TARGET_FILE "reference/cells.cpp"
#include "simd/foreach_target.h"

#include "reference/cut-inl.h"
#include "simd/members-inl.h"

LAMINA_SIMD_BEGIN
namespace reference {

struct CornerLanes {
    Double v[8];

    LAMINA_INLINE CornerLanes(const CellBatch& cells, std::size_t i) {
        for (std::size_t corner = 0; corner < 8; ++corner)
            v[corner] = load<Double>(cells.corners[corner] + i);
    }
    LAMINA_INLINE Double least() const {
        return min(min(min(v[0], v[1]), min(v[2], v[3])), min(min(v[4], v[5]), min(v[6], v[7])));
    }
    LAMINA_INLINE Double most() const {
        return max(max(max(v[0], v[1]), max(v[2], v[3])), max(max(v[4], v[5]), max(v[6], v[7])));
    }
    // Tells which cells have finite corners: eight finite floats have a finite sum in double.
    LAMINA_INLINE DoubleMask finite() const {
        return is_finite(v[0] + v[1] + (v[2] + v[3]) + (v[4] + v[5] + (v[6] + v[7])));
    }
};

// The chord's paths through a vector of cells: start + t * step, 0 <= t <= 1, in cell coordinates.
struct PathLanes {
    Double start[3], step[3], along;

    LAMINA_INLINE PathLanes(const CellBatch& cells, const Chord& chord, std::size_t i) {
        const Double from = load<Double>(cells.from + i);
        along = load<Double>(cells.to + i) - from;
        for (int axis = 0; axis < 3; ++axis) {
            const Double direction(chord.direction[axis]);
            const Double at = fma(from, direction, chord.entry[axis]);
            const Double cell = to_double(load<Long>(cells.cell[axis] + i));
            start[axis] = clamp(at - cell, 0, 1);
            step[axis] = along * direction;
        }
    }
};

LAMINA_INLINE Cubics field_along(const CornerLanes& corners, const PathLanes& path) {
    const Double(&v)[8] = corners.v;
    const Double x = v[1] - v[0], y = v[2] - v[0], z = v[4] - v[0];
    const Double xy = v[3] - v[2] - x, xz = v[5] - v[4] - x;
    const Double yz = v[6] - v[4] - y;
    const Double xyz = v[7] - v[6] - (v[5] - v[4]) - xy;
    const auto& [u, w, q] = path.start;
    const auto& [du, dw, dq] = path.step;
    // The field's derivatives at the start, by each axis and by pairs of them.
    const Double by_xy = fma(q, xyz, xy), by_xz = fma(w, xyz, xz), by_yz = fma(u, xyz, yz);
    const Double by_x = fma(w, by_xy, fma(q, xz, x)), by_y = fma(u, by_xy, fma(q, yz, y));
    const Double by_z = fma(u, by_xz, fma(w, yz, z));
    Cubics field;
    field.c[0] = fma(u, by_x, fma(w, fma(q, yz, y), fma(q, z, v[0])));
    field.c[1] = fma(du, by_x, fma(dw, by_y, dq * by_z));
    field.c[2] = fma(du * dw, by_xy, fma(du * dq, by_xz, dw * dq * by_yz));
    field.c[3] = du * dw * (dq * xyz);
    return field;
}

}  // namespace reference

// Outside of `reference`, because LAMINA_EXPORT takes only functions of this namespace.
inline void make_segments_of(const CellBatch& cells, const Chord& chord,
                             const IntervalColumns& intervals, SegmentBatch& segments) {
    using namespace reference;
    const VisibleRanges visible(intervals);
    segments.count = 0;
    for (std::size_t i = 0; i < cells.count; i += Double::lanes) {
        const CornerLanes corners(cells, i);
        const Double lo = corners.least(), hi = corners.most();
        const DoubleMask seen =
            visible.meet(lo, hi) & corners.finite() & first_lanes<DoubleMask>(cells.count - i);
        if (none_of(seen)) continue;
        const PathLanes path(cells, chord, i);
        const Cubics field = field_along(corners, path);
        const KeptLanes kept(seen);
        const std::size_t first = segments.count;
        for (std::size_t power = 0; power < 4; ++power)
            kept.store(field.c[power], segments.scalar[power] + first);
        kept.store(lo, segments.lo + first);
        kept.store(hi, segments.hi + first);
        kept.store(path.along * chord.world_per_z, segments.length + first);
        kept.store(iota<Long>(static_cast<std::int64_t>(i)), segments.cell + first);
        segments.count += kept.count();
    }
}

LAMINA_SIMD_END

#if LAMINA_ONCE
namespace lamina {
namespace {

// Number of ranges of visible values above which one range, first to last, replaces them.
constexpr std::size_t most_ranges = 8;

// A range of values, converted to the type of the samples. Samples inside it stay inside.
template <typename Sample>
class SampleRange {
  public:
    SampleRange(double from, double to) {
        if constexpr (std::is_integral_v<Sample>) {
            from = std::ceil(from);
            to = std::floor(to);
        }
        constexpr double least = std::numeric_limits<Sample>::lowest();
        constexpr double most = std::numeric_limits<Sample>::max();
        out_of_reach_ = to < least || most < from;
        lo_ = static_cast<Sample>(std::clamp(from, least, most));
        hi_ = static_cast<Sample>(std::clamp(to, least, most));
        if constexpr (std::is_floating_point_v<Sample>) {
            lo_ = std::nextafter(lo_, std::numeric_limits<Sample>::lowest());
            hi_ = std::nextafter(hi_, std::numeric_limits<Sample>::max());
        }
    }

    // Tells whether the range lies beyond all values of the type, so that no cell meets it.
    bool out_of_reach() const { return out_of_reach_; }
    // Returns bit 0 if the value is not below the range, and bit 1 if it is not above it. A cell
    // may meet the range if both bits occur among its corners.
    std::uint8_t sides(Sample value) const {
        return static_cast<std::uint8_t>((value >= lo_ ? 1 : 0) | (value <= hi_ ? 2 : 0));
    }

  private:
    Sample lo_, hi_;
    bool out_of_reach_;
};

// The samples of a line of blocks along x, row by row; the border sample repeats.
template <typename Sample>
class SampleRows {
  public:
    static constexpr std::int64_t edge = VisibleCells::edge;

    SampleRows(const Sample* samples, const std::array<std::int64_t, 3>& size, std::int64_t y,
               std::int64_t z)
        : samples_(samples), size_(size), y_(y), z_(z), width_(size[0] / edge * edge + edge) {
        sides_.resize(static_cast<std::size_t>((edge + 1) * (edge + 1) * (width_ + 1)));
    }

    // Sets the bits of cells that may have a value of the range. Corners that are NaN do not count.
    void mark(const SampleRange<Sample>& range, std::uint8_t* rows) {
        for (std::int64_t z = 0; z <= edge; ++z) {
            for (std::int64_t y = 0; y <= edge; ++y) find_sides(range, y, z);
            for (std::int64_t y = 0; y < edge; ++y) join(at(y, z), at(y + 1, z));
        }
        for (std::int64_t z = 0; z < edge; ++z) {
            for (std::int64_t y = 0; y < edge; ++y) {
                join(at(y, z), at(y, z + 1));
                mark_row(at(y, z), rows + z * edge + y);
            }
        }
    }

  private:
    std::uint8_t* at(std::int64_t y, std::int64_t z) {
        return sides_.data() + (z * (edge + 1) + y) * (width_ + 1);
    }
    void join(std::uint8_t* sides, const std::uint8_t* others) const {
        for (std::int64_t x = 0; x < width_; ++x) sides[x] |= others[x];
    }

    // Sets the sides of each pair of samples along a row; the first is the border sample twice.
    void find_sides(const SampleRange<Sample>& range, std::int64_t y, std::int64_t z) {
        const std::int64_t row = std::clamp<std::int64_t>(y_ + y, 0, size_[1] - 1);
        const std::int64_t slice = std::clamp<std::int64_t>(z_ + z, 0, size_[2] - 1);
        const Sample* const values = samples_ + (slice * size_[1] + row) * size_[0];
        std::uint8_t* const sides = at(y, z);
        sides[0] = range.sides(values[0]);
        for (std::int64_t x = 0; x < size_[0]; ++x) sides[x + 1] = range.sides(values[x]);
        std::fill(sides + size_[0] + 1, sides + width_ + 1, sides[size_[0]]);
        for (std::int64_t x = 0; x < width_; ++x) sides[x] |= sides[x + 1];
    }

    void mark_row(const std::uint8_t* sides, std::uint8_t* row) const {
        for (std::int64_t x = 0; x < width_; x += edge, row += edge * edge) {
            std::uint64_t eight;  // the lowest byte belongs to the first cell
            static_assert(std::endian::native == std::endian::little && edge == sizeof eight);
            std::memcpy(&eight, sides + x, sizeof eight);
            const std::uint64_t both = eight & eight >> 1 & 0x0101010101010101;
            // The product packs the lowest bits of the eight bytes into the highest byte.
            *row |= static_cast<std::uint8_t>(both * 0x0102040810204080 >> 56);
        }
    }

    const Sample* samples_;
    std::array<std::int64_t, 3> size_;
    std::int64_t y_, z_, width_;
    std::vector<std::uint8_t> sides_;  // SampleRange::sides(), row by row
};

template <typename Sample>
std::vector<SampleRange<Sample>> sample_ranges(const IntervalColumns& columns) {
    std::vector<SampleRange<Sample>> ranges;
    const auto add = [&](double lo, double hi) {
        if (const SampleRange<Sample> range(lo, hi); !range.out_of_reach()) ranges.push_back(range);
    };
    const std::size_t count = columns.visible_count;
    if (count > most_ranges) {
        add(columns.visible_lo[0], columns.visible_hi[count - 1]);
    } else {
        for (std::size_t i = 0; i < count; ++i) add(columns.visible_lo[i], columns.visible_hi[i]);
    }
    return ranges;
}

}  // namespace

LAMINA_EXPORT(make_segments_of);

void make_segments(const CellBatch& cells, const Chord& chord, const IntervalColumns& intervals,
                   SegmentBatch& segments) {
    LAMINA_DISPATCH(make_segments_of)(cells, chord, intervals, segments);
}

std::array<std::int64_t, 3> VisibleCells::blocks_of(const Grid& grid) {
    std::array<std::int64_t, 3> blocks;
    for (std::size_t axis = 0; axis < 3; ++axis) blocks[axis] = grid.size[axis] / edge + 1;
    return blocks;
}

std::uint64_t VisibleCells::bytes_for(const Grid& grid) {
    const std::array<std::int64_t, 3> count = blocks_of(grid);
    return 8 * static_cast<std::uint64_t>(count[1] * count[2]) *
           (static_cast<std::uint64_t>(count[0]) * words_of_block + (count[0] + 63) / 64);
}

VisibleCells::VisibleCells(const Volume& volume, const TransferIntervals& transfer)
    : count_(blocks_of(volume.grid())), line_words_((count_[0] + 63) / 64) {
    const std::int64_t lines = count_[1] * count_[2];
    const auto blocks_of_line = static_cast<std::size_t>(count_[0]);
    blocks_.resize(static_cast<std::size_t>(lines * line_words_));
    cells_.resize(static_cast<std::size_t>(lines) * blocks_of_line * words_of_block);
    volume.visit([&](const auto* samples) {
        using Sample = std::remove_cvref_t<decltype(*samples)>;
        const auto ranges = sample_ranges<Sample>(transfer.columns());
        parallel_for(lines, 1, [&](std::int64_t line) {
            const std::int64_t y = line % count_[1] * edge - 1, z = line / count_[1] * edge - 1;
            std::uint64_t* cells =
                cells_.data() + static_cast<std::size_t>(line) * blocks_of_line * words_of_block;
            SampleRows<Sample> line_of_blocks(samples, volume.grid().size, y, z);
            for (const auto& range : ranges)
                line_of_blocks.mark(range, reinterpret_cast<std::uint8_t*>(cells));
            std::uint64_t* const blocks = blocks_.data() + line * line_words_;
            for (std::size_t block = 0; block < blocks_of_line; ++block, cells += words_of_block) {
                const bool shows =
                    std::any_of(cells, cells + words_of_block, [](auto word) { return word != 0; });
                blocks[block / 64] |= std::uint64_t{shows} << block % 64;
            }
        });
    });
}

}  // namespace lamina
#endif
