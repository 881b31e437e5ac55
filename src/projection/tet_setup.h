// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "projection/tet_projector.h"

namespace lamina {

// Results of a fast form of TetProjector, which works on vectors of several cell fragments. It
// handles only clear cases: the eye is well away from the planes of all faces, and the tet lies
// beyond the near plane. The others need care and are left to TetProjector.
struct TetSetup {
    static constexpr std::size_t most_cell_fragments = 8;  // in one call
    // invisible: no pixel centre is covered; needs_care: left to TetProjector.
    enum class Outcome : std::uint8_t { invisible, done, needs_care };

    // Rows from the top; of whole tets, unless `careful`.
    std::array<CoveredArea, most_cell_fragments> areas;
    std::array<Outcome, most_cell_fragments> outcomes;
};

// Sets up at most `most_cell_fragments` cell fragments: all whole tets, or none. Records and areas
// are arbitrary unless the outcome is `done`. `careful`: sets up FragmentKind::careful, with the
// same bits as TetProjector; otherwise cell fragments that need it are left to TetProjector.
// `records`, and `lit` unless null (nothing is lit), have an element for each cell fragment.
// `next`: those that follow, which are prefetched.
void set_up_tets(const TetsInView& tets, std::span<const CellFragment> cell_fragments,
                 std::span<const CellFragment> next, bool careful, SilhouetteRecord* records,
                 GradientRecord* lit, TetSetup& result);

// Input and output of the vectors, each row with one number a cell fragment. Corners ascend by
// place, so that both tets of a face compute the same numbers. If `careful` they have the tet's
// order, and the vectors sort those of each face, as TetProjector does.
struct SetupLanes {
    struct alignas(64) Row : std::array<double, TetSetup::most_cell_fragments> {};
    struct alignas(32) FloatRow : std::array<float, TetSetup::most_cell_fragments> {};
    // Four numbers that lie side by side in a record.
    using Group = std::array<FloatRow, 4>;

    std::array<Row, 4> x, y, z, value;  // input: corners, and the scalars there
    std::array<Row, 4> place;           // input, if careful: TetMesh::place() of the corners
    Row piece_from, piece_to;           // input: scalars at the ends of the piece
    std::array<Row, 4> at_from, at_to;  // input: colour and extinction at these scalars
    // Input, if lit: the components of the gradient, for each corner.
    std::array<std::array<Row, 4>, 3> gradient;
    Row good, visible, bounded;                    // output: 1 or 0
    Row farthest;                                  // CoveredArea::farthest
    Row largest_depth;                             // bound on the optical depth of a segment
    Group pixels;                                  // PixelArea, in the bits of integers
    Group depth, per_column, per_row;              // planes of the faces, as in SeenTet
    Group depth_low, per_column_low, per_row_low;  // if careful: their remainders in float
    Group center;                                  // column, row, depth and z
    Group scalar;                                  // at the center, per z, per column and per row
    Group scalar_rest;                             // if careful: TetRecord::scalar_rest
    // Least and largest scalar of a whole tet, or the upper cut of a fragment per column and per
    // row; then, in the bits of integers, TetRecord::fronts and (input) ::number.
    Group limits;
    Group cuts;                // lower: depth, per column, per row; upper: depth
    Group low, high;           // as in FragmentRecord
    std::array<Group, 3> lit;  // the components of GradientRecord
};

// The sign of a determinant is doubtful below this share of the product of its vectors' largest
// components: 450 half ulps, for some 20 roundings.
inline constexpr double doubtful_sign = 1e-13;

// Smallest width, as a share of the distance from the eye, of a tet that is drawn. In eye space its
// corners have rounding errors of about a 1000th of this width. Planes through the corners of a
// thinner tet, a needle, could lie anywhere. A ray meets one with about this probability.
inline constexpr double least_width = 0x1p-42;

inline constexpr double float_epsilon = std::numeric_limits<float>::epsilon();

}  // namespace lamina
