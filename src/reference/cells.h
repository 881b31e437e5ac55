// SPDX-License-Identifier: Apache-2.0
// The cells of a volume along a ray, and the field in them, a batch of cells at a time:
//   for each cell that the ray crosses from `from` to `to`:
//       v = the samples at its eight corners
//       if one of them is not finite, or no interval of the transfer function that their range
//           touches has extinction: the cell is invisible
//       otherwise it has a segment: its length, the range of v, and the cubic s(t) along it (9.1)
// Segments that are lit also have the gradient, whose components are such cubics. Numbers in
// brackets are equations of docs/numerics.md; gradients are in section 10.2.
#pragma once

#include <glm/geometric.hpp>
#include <type_traits>

#include "lamina/volume.h"
#include "reference/chord.h"
#include "reference/cut.h"
#include "reference/transfer_intervals.h"
#include "volume/volume_store.h"

namespace lamina {

// Numbers of a cell along the three axes. Cell i of an axis lies between samples i and i + 1. On
// cell-centred axes, -1 and size - 1 are the half voxels at the ends.
using CellIndex = std::array<std::int64_t, 3>;

struct CellBatch {
    static constexpr std::size_t capacity = SegmentBatch::capacity;

    alignas(64) std::int64_t cell[3][capacity];
    alignas(64) double from[capacity];  // chord's parameters at entry and exit
    alignas(64) double to[capacity];
    std::size_t count = 0;
    std::size_t wanted = capacity;  // number of cells with which the batch is complete

    // Samples at index x + 2y + 4z. CellSamples::fetch() sets them.
    alignas(64) double corners[8][capacity];

    bool complete() const { return count >= wanted; }
    void add(const CellIndex& index, double begin, double end) {
        for (std::size_t axis = 0; axis < 3; ++axis) cell[axis][count] = index[axis];
        from[count] = begin;
        to[count] = end;
        ++count;
    }
};

// Sets `segments` to the chord's parts in cells that may be visible; cells with NaN or infinite
// corners are transparent. CellCorners::along() does this for a single cell.
void make_segments(const CellBatch& cells, const Chord& chord, const IntervalColumns& intervals,
                   SegmentBatch& segments);

// The eight samples at the corners of a cell, at index x + 2y + 4z.
struct CellCorners {
    std::array<double, 8> v;

    // Returns the field along from + t * step, 0 <= t <= 1, in the cell's coordinates (0..1), from
    // differences of corners: constant cells stay exactly constant, and linear ones linear.
    Cubic along(const glm::dvec3& from, const glm::dvec3& step) const {
        const double x = v[1] - v[0], y = v[2] - v[0], z = v[4] - v[0];
        const double xy = (v[3] - v[2]) - x, xz = (v[5] - v[4]) - x, yz = (v[6] - v[4]) - y;
        const double xyz = ((v[7] - v[6]) - (v[5] - v[4])) - xy;
        const auto& [u, w, q] = std::array<double, 3>{from.x, from.y, from.z};
        const auto& [du, dw, dq] = std::array<double, 3>{step.x, step.y, step.z};
        Cubic field;
        field.c[0] =
            v[0] + u * x + w * y + q * z + u * w * xy + u * q * xz + w * q * yz + u * w * q * xyz;
        field.c[1] = du * (x + w * xy + q * xz + w * q * xyz) +
                     dw * (y + u * xy + q * yz + u * q * xyz) +
                     dq * (z + u * xz + w * yz + u * w * xyz);
        field.c[2] = du * dw * (xy + q * xyz) + du * dq * (xz + w * xyz) + dw * dq * (yz + u * xyz);
        field.c[3] = du * dw * dq * xyz;
        return field;
    }
};

// Reads cells' corners from memory (a pointer) or disk (SamplesInFiles); the border sample repeats.
// If lookup is nearest, a cell is a voxel, and all its corners have its sample's value.
template <typename Samples>
class CellSamples {
  public:
    CellSamples(const Grid& grid, const Samples& samples)
        : samples_(samples),
          last_{grid.size[0] - 1, grid.size[1] - 1, grid.size[2] - 1},
          row_(grid.size[0]),
          slice_(grid.size[0] * grid.size[1]),
          reach_(grid.lookup == VolumeLookup::nearest ? 0 : 1) {}

    CellCorners corners(const CellIndex& cell) const {
        if constexpr (!std::is_pointer_v<Samples>) return stored_corners(cell);
        const std::int64_t x0 = clamped(cell[0], 0), x1 = clamped(cell[0] + reach_, 0);
        const std::int64_t y0 = clamped(cell[1], 1) * row_;
        const std::int64_t y1 = clamped(cell[1] + reach_, 1) * row_;
        const std::int64_t z0 = clamped(cell[2], 2) * slice_;
        const std::int64_t z1 = clamped(cell[2] + reach_, 2) * slice_;
        return {at(x0 + y0 + z0), at(x1 + y0 + z0), at(x0 + y1 + z0), at(x1 + y1 + z0),
                at(x0 + y0 + z1), at(x1 + y0 + z1), at(x0 + y1 + z1), at(x1 + y1 + z1)};
    }

    void fetch(CellBatch& cells) const {
        for (std::size_t i = 0; i < cells.count; ++i) {
            const CellIndex cell{cells.cell[0][i], cells.cell[1][i], cells.cell[2][i]};
            if constexpr (std::is_pointer_v<Samples>) {
                if (reach_ == 1 && inside(cell)) {
                    fetch_inside(cell, cells, i);
                    continue;
                }
            }
            const CellCorners values = corners(cell);
            for (std::size_t corner = 0; corner < 8; ++corner)
                cells.corners[corner][i] = values.v[corner];
        }
    }

  private:
    CellCorners stored_corners(const CellIndex& cell) const requires(!std::is_pointer_v<Samples>) {
        std::array<std::int64_t, 3> lower{}, upper{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            lower[axis] = clamped(cell[axis], axis);
            upper[axis] = clamped(cell[axis] + reach_, axis);
        }
        const auto samples = samples_.corners(lower, upper);
        CellCorners found;
        for (std::size_t i = 0; i < 8; ++i) found.v[i] = static_cast<double>(samples[i]);
        return found;
    }
    bool inside(const CellIndex& cell) const {
        const auto number = [](std::int64_t i) { return static_cast<std::uint64_t>(i); };
        return number(cell[0]) < number(last_[0]) && number(cell[1]) < number(last_[1]) &&
               number(cell[2]) < number(last_[2]);
    }
    void fetch_inside(const CellIndex& cell, CellBatch& cells, std::size_t i) const {
        const auto* const sample = samples_ + cell[0] + cell[1] * row_ + cell[2] * slice_;
        const std::int64_t steps[8]{0,      1,          row_,          row_ + 1,
                                    slice_, slice_ + 1, slice_ + row_, slice_ + row_ + 1};
        for (std::size_t corner = 0; corner < 8; ++corner)
            cells.corners[corner][i] = static_cast<double>(sample[steps[corner]]);
    }
    double at(std::int64_t offset) const { return static_cast<double>(samples_[offset]); }
    std::int64_t clamped(std::int64_t index, std::size_t axis) const {
        return std::clamp<std::int64_t>(index, 0, last_[axis]);
    }

    Samples samples_;
    std::array<std::int64_t, 3> last_;
    std::int64_t row_, slice_;
    std::int64_t reach_;  // from a cell's lower to its upper corner, in samples
};

// The trilinear gradient (docs/numerics.md, section 10), in scalar units per world unit. If lookup
// is nearest, the field is constant in each voxel, and its gradient 0.
template <typename Samples>
class GradientSamples {
  public:
    GradientSamples(const Grid& grid, const Samples& samples)
        : samples_(samples), size_(grid.size), constant_(grid.lookup == VolumeLookup::nearest) {
        stride_ = {1, size_[0], size_[0] * size_[1]};
        for (std::size_t axis = 0; axis < 3; ++axis)
            axes_[axis] = grid.step[axis] / glm::dot(grid.step[axis], grid.step[axis]);
    }

    // Returns the gradient along from + t * step, 0 <= t <= 1, in the cell's coordinates (0..1).
    GradientAlong along(const CellIndex& cell, const glm::dvec3& from,
                        const glm::dvec3& step) const {
        if (constant_) return {};
        std::array<CellCorners, 3> corners;
        for (std::size_t corner = 0; corner < 8; ++corner) {
            const glm::dvec3 gradient = at({cell[0] + static_cast<std::int64_t>(corner & 1),
                                            cell[1] + static_cast<std::int64_t>(corner >> 1 & 1),
                                            cell[2] + static_cast<std::int64_t>(corner >> 2)});
            for (int c = 0; c < 3; ++c) corners[c].v[corner] = gradient[c];
        }
        return {corners[0].along(from, step), corners[1].along(from, step),
                corners[2].along(from, step)};
    }

  private:
    glm::dvec3 at(CellIndex index) const {
        std::int64_t offset = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            index[axis] = std::clamp<std::int64_t>(index[axis], 0, size_[axis] - 1);
            offset += index[axis] * stride_[axis];
        }
        glm::dvec3 gradient(0);
        for (std::size_t axis = 0; axis < 3; ++axis)
            gradient += difference(offset, index[axis], axis) * axes_[axis];
        return gradient;
    }

    // Returns the scalar's difference per grid step, by finite neighbours; 0 if none is finite.
    double difference(std::int64_t offset, std::int64_t index, std::size_t axis) const {
        const auto value = [&](std::int64_t steps) {
            return static_cast<double>(samples_[offset + steps * stride_[axis]]);
        };
        const bool below = index > 0 && std::isfinite(value(-1));
        const bool above = index + 1 < size_[axis] && std::isfinite(value(1));
        if (below && above) return 0.5 * (value(1) - value(-1));
        if (above) return value(1) - value(0);
        if (below) return value(0) - value(-1);
        return 0;
    }

    Samples samples_;
    std::array<std::int64_t, 3> size_, stride_;
    std::array<glm::dvec3, 3> axes_;
    bool constant_;
};

// Two sets of bits for a volume in memory: which cells may be visible, and which blocks of edge^3
// cells contain such a cell. Block n of an axis begins at cell n * edge - 1. It does not use
// MinMaxBricks, because the reference is there to check these.
class VisibleCells {
  public:
    static constexpr std::int64_t edge = 8;

    VisibleCells() = default;
    VisibleCells(const Volume& volume, const TransferIntervals& transfer);  // parallel
    static std::uint64_t bytes_for(const Grid& grid);

    bool empty() const { return cells_.empty(); }

    const std::array<std::int64_t, 3>& count() const { return count_; }
    // Returns a bit for each block: 1 if it has visible cells. x is fastest, padded to line_bits().
    const std::uint64_t* blocks() const { return blocks_.data(); }
    std::int64_t line_bits() const { return line_words_ * 64; }
    // Returns a bit for each cell, block by block (x fastest), and x fastest inside a block.
    const std::uint64_t* cells() const { return cells_.data(); }

  private:
    static constexpr std::size_t words_of_block = edge * edge * edge / 64;
    static std::array<std::int64_t, 3> blocks_of(const Grid& grid);

    std::array<std::int64_t, 3> count_{};  // number of blocks along each axis
    std::int64_t line_words_ = 0;          // 64-bit words that hold a line of blocks along x
    std::vector<std::uint64_t> blocks_;
    std::vector<std::uint64_t> cells_;
};

}  // namespace lamina
