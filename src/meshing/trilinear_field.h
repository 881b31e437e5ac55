// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "lamina/volume.h"
#include "mesh/tet_mesh.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// A volume as a trilinear field in index space, cut into cells by planes. Along a `node` axis of n
// samples, planes lie at 0, ..., n - 1. A `cell` axis has two more, at -1/2 and n - 1/2 (the border
// value repeats there). An axis of one sample has planes at -1/2 and 1/2.
class TrilinearField {
  public:
    using Cell = std::array<std::int32_t, 3>;  // between plane i and plane i + 1 of each axis
    using Corners = std::array<double, 8>;     // values at a cell's corners: x + 2y + 4z

    // Copies the samples to float, which is exact. Throws Error for samples that are not finite.
    explicit TrilinearField(const Volume& volume);

    std::span<const double> planes(int axis) const { return planes_[axis]; }
    std::int32_t cell_count(int axis) const {
        return static_cast<std::int32_t>(planes_[axis].size()) - 1;
    }
    glm::dvec3 min() const { return {planes_[0].front(), planes_[1].front(), planes_[2].front()}; }
    glm::dvec3 max() const { return {planes_[0].back(), planes_[1].back(), planes_[2].back()}; }
    const ValueRange& range() const { return range_; }

    // Returns the cell of a place, or the nearest; on a plane between two cells, the upper one.
    Cell cell_of(const glm::dvec3& index) const;
    Corners corners(const Cell& cell) const;
    double at_plane(const Cell& plane) const;  // value where the planes of these numbers meet
    double at(const glm::dvec3& index) const;

  private:
    std::array<std::vector<double>, 3> planes_;
    std::array<std::int32_t, 3> shift_{0, 0, 0};  // planes before the first sample
    std::array<std::int64_t, 3> size_{1, 1, 1};
    std::vector<float> samples_;
    ValueRange range_;
};

// The ranges of values in blocks of 2^level cells along each axis, up to a level of a single block.
class CellRanges {
  public:
    explicit CellRanges(const TrilinearField& field);  // parallel; a quarter of the field's memory

    int levels() const { return static_cast<int>(levels_.size()); }
    ValueRange of_block(int level, const TrilinearField::Cell& block) const {
        const Level& blocks = levels_[level - 1];
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

// A tet in a cell's coordinates (0..1), with the values of a linear function at its corners.
struct CellPiece {
    std::array<glm::dvec3, 4> corners;
    std::array<double, 4> values;
};

// Replaces each tet by tets that fill the part of it in the cell. `spare` is working memory.
void clip_to_cell(std::vector<CellPiece>& pieces, std::vector<CellPiece>& spare);

// A trilinear function on a cell as a polynomial. The coefficient of x^i y^j z^k is at i + 2j + 4k.
struct TrilinearPolynomial {
    std::array<double, 8> c;

    explicit TrilinearPolynomial(const std::array<double, 8>& corner_values);
    double at(const glm::dvec3& p) const;
    glm::dvec3 gradient(const glm::dvec3& p) const;
    // Returns u^T H v; H is the matrix of second derivatives at p.
    double second_derivative(const glm::dvec3& p, const glm::dvec3& u, const glm::dvec3& v) const;
};

// A trilinear function, and its difference from a linear one, on a tet: cubics in Bernstein form.
// Their values lie between the least and the largest coefficient.
struct BernsteinCubic {
    // Coefficients: 0 to 3 at corners; 4 + 2i, 5 + 2i near the ends of tet_edges[i]; 16 + i in face
    // i.
    std::array<double, 20> trilinear;   // coefficients of the trilinear function
    std::array<double, 20> difference;  // coefficients of trilinear - linear

    BernsteinCubic(const TrilinearPolynomial& polynomial, const CellPiece& piece);
    double largest() const;  // upper bound of |difference|
    // Returns the edge whose halving brings the bound nearest to the true values.
    std::size_t edge_to_halve(const CellPiece& piece) const;
};

}  // namespace lamina
