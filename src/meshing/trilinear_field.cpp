// SPDX-License-Identifier: Apache-2.0
#include "meshing/trilinear_field.h"

#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include "base/error.h"
#include "base/parallel.h"
#include "lamina/mesh.h"
#include "volume/sample_source.h"
#include "volume/volume_store.h"

namespace lamina {
namespace {

std::vector<double> planes_along(std::int64_t samples, double first, double last) {
    std::vector<double> planes;
    if (samples == 1) return {first, last};
    if (first < 0) planes.push_back(first);
    for (std::int64_t i = 0; i < samples; ++i) planes.push_back(static_cast<double>(i));
    if (first < 0) planes.push_back(last);
    return planes;
}

std::vector<float> samples_of(const Volume& volume) {
    const std::int64_t count = volume.grid().sample_count();
    std::vector<float> copy(static_cast<std::size_t>(count));
    const auto convert = [](auto sample) { return static_cast<float>(sample); };
    if (volume.in_memory()) {
        volume.visit([&](const auto* samples) {
            std::transform(samples, samples + count, copy.begin(), convert);
        });
        return copy;
    }
    const auto& size = volume.grid().size;
    with_sample_type(volume.type(), [&](auto zero) {
        std::vector<decltype(zero)> layer(static_cast<std::size_t>(size[0] * size[1]));
        auto to = copy.begin();
        for (std::int64_t z = 0; z < size[2]; ++z) {
            volume.store().source().read({{0, 0, z}, {size[0], size[1], 1}}, layer.data());
            to = std::transform(layer.begin(), layer.end(), to, convert);
        }
    });
    return copy;
}

constexpr float float_infinity = std::numeric_limits<float>::infinity();

std::array<std::int64_t, 3> half_of(const std::array<std::int64_t, 3>& count) {
    return {(count[0] + 1) / 2, (count[1] + 1) / 2, (count[2] + 1) / 2};
}

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

// The point where a tet's edge crosses a plane of the cell, and the linear function's value there.
struct Crossing {
    glm::dvec3 point;
    double value;
};

Crossing cross(const CellPiece& piece, std::size_t in, std::size_t out, int axis, double level) {
    const glm::dvec3 &p = piece.corners[in], &q = piece.corners[out];
    const double t = (level - p[axis]) / (q[axis] - p[axis]);
    Crossing crossing{p + t * (q - p),
                      piece.values[in] + t * (piece.values[out] - piece.values[in])};
    crossing.point[axis] = level;
    return crossing;
}

CellPiece piece_of(const std::array<Crossing, 4>& corners) {
    return {{corners[0].point, corners[1].point, corners[2].point, corners[3].point},
            {corners[0].value, corners[1].value, corners[2].value, corners[3].value}};
}

void add_prism(const std::array<Crossing, 3>& a, const std::array<Crossing, 3>& b,
               std::vector<CellPiece>& pieces) {
    pieces.push_back(piece_of({a[0], a[1], a[2], b[0]}));
    pieces.push_back(piece_of({a[1], a[2], b[0], b[1]}));
    pieces.push_back(piece_of({a[2], b[0], b[1], b[2]}));
}

// Adds the part of `piece` for which sign * (coordinate - level) >= 0, as tets.
void add_part(const CellPiece& piece, int axis, double level, double sign,
              std::vector<CellPiece>& pieces) {
    std::array<std::size_t, 4> in{}, out{};
    std::size_t in_count = 0, out_count = 0;
    bool touches_only = true;
    for (std::size_t corner = 0; corner < 4; ++corner) {
        const double side = sign * (piece.corners[corner][axis] - level);
        if (side > 0) touches_only = false;
        if (side >= 0) {
            in[in_count++] = corner;
        } else {
            out[out_count++] = corner;
        }
    }
    if (touches_only && out_count > 0) return;
    const auto corner = [&](std::size_t i) {
        return Crossing{piece.corners[in[i]], piece.values[in[i]]};
    };
    const auto cut = [&](std::size_t i, std::size_t o) {
        return cross(piece, in[i], out[o], axis, level);
    };
    switch (in_count) {
        case 4:
            pieces.push_back(piece);
            break;
        case 3:
            add_prism({corner(0), corner(1), corner(2)}, {cut(0, 0), cut(1, 0), cut(2, 0)}, pieces);
            break;
        case 2:
            add_prism({corner(0), cut(0, 0), cut(0, 1)}, {corner(1), cut(1, 0), cut(1, 1)}, pieces);
            break;
        case 1:
            pieces.push_back(piece_of({corner(0), cut(0, 0), cut(0, 1), cut(0, 2)}));
            break;
        default:
            break;
    }
}

struct EdgeChoice {
    std::size_t edge = 0;
    double score = -1;
    void offer(std::size_t other, double its_score) {
        if (its_score > score) *this = {other, its_score};
    }
};

}  // namespace

TrilinearField::TrilinearField(const Volume& volume) : size_(volume.grid().size) {
    const MinMaxBricks bricks = measure_bricks(volume);
    if (bricks.non_finite > 0) {
        fail("{} of {} samples are NaN or infinite: no mesh can follow them", bricks.non_finite,
             volume.grid().sample_count());
    }
    range_ = bricks.whole;
    const glm::dvec3 first = volume.grid().index_min(), last = volume.grid().index_max();
    for (int axis = 0; axis < 3; ++axis) {
        if (size_[axis] > std::numeric_limits<std::int32_t>::max() - 2) {
            fail("the volume has {} samples along axis {}: expected fewer than 2^31", size_[axis],
                 axis);
        }
        planes_[axis] = planes_along(size_[axis], first[axis], last[axis]);
        shift_[axis] = size_[axis] > 1 && first[axis] < 0 ? 1 : 0;
    }
    samples_ = samples_of(volume);
}

TrilinearField::Cell TrilinearField::cell_of(const glm::dvec3& index) const {
    Cell cell{};
    for (int axis = 0; axis < 3; ++axis) {
        const double last = cell_count(axis) - 1;
        const double plane = size_[axis] == 1 ? 0 : std::floor(index[axis]) + shift_[axis];
        cell[axis] = static_cast<std::int32_t>(std::clamp(plane, 0.0, last));
    }
    return cell;
}

double TrilinearField::at_plane(const Cell& plane) const {
    std::array<std::int64_t, 3> sample{};
    for (int axis = 0; axis < 3; ++axis) {
        sample[axis] = std::clamp<std::int64_t>(plane[axis] - shift_[axis], 0, size_[axis] - 1);
    }
    return samples_[(sample[2] * size_[1] + sample[1]) * size_[0] + sample[0]];
}

TrilinearField::Corners TrilinearField::corners(const Cell& cell) const {
    Corners values{};
    for (std::size_t corner = 0; corner < 8; ++corner) {
        values[corner] = at_plane({cell[0] + static_cast<std::int32_t>(corner & 1),
                                   cell[1] + static_cast<std::int32_t>((corner >> 1) & 1),
                                   cell[2] + static_cast<std::int32_t>(corner >> 2)});
    }
    return values;
}

double TrilinearField::at(const glm::dvec3& index) const {
    const Cell cell = cell_of(index);
    Corners v = corners(cell);
    for (int axis = 2; axis >= 0; --axis) {
        const double lo = planes_[axis][cell[axis]], hi = planes_[axis][cell[axis] + 1];
        const double t = (index[axis] - lo) / (hi - lo);
        for (int i = 0; i < (1 << axis); ++i) v[i] += t * (v[i + (1 << axis)] - v[i]);
    }
    return v[0];
}

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
    // Returns the union of range_at(place) from 2 * block to `reach` beyond, at most up to `last`.
    const auto range_of = [](const TrilinearField::Cell& block, int reach,
                             const std::array<std::int64_t, 3>& last, const auto& range_at) {
        TrilinearField::Cell from{}, to{};
        for (int axis = 0; axis < 3; ++axis) {
            from[axis] = 2 * block[axis];
            to[axis] =
                static_cast<std::int32_t>(std::min<std::int64_t>(from[axis] + reach, last[axis]));
        }
        Range range{float_infinity, -float_infinity};
        for_each(from, to, [&](const TrilinearField::Cell& place) {
            const Range part = range_at(place);
            range = {std::min(range.lo, part.lo), std::max(range.hi, part.hi)};
        });
        return range;
    };
    // A block of level 1 includes the planes on both sides of its cells.
    add_level(half_of(count), [&](const TrilinearField::Cell& block) {
        return range_of(block, 2, count, [&](const TrilinearField::Cell& plane) {
            const auto value = static_cast<float>(field.at_plane(plane));
            return Range{value, value};
        });
    });
    for (count = half_of(count); count[0] > 1 || count[1] > 1 || count[2] > 1;
         count = half_of(count)) {
        const std::size_t below = levels_.size() - 1;
        add_level(half_of(count), [&](const TrilinearField::Cell& block) {
            const std::array<std::int64_t, 3> last{count[0] - 1, count[1] - 1, count[2] - 1};
            return range_of(block, 1, last, [&](const TrilinearField::Cell& child) {
                return levels_[below].ranges[levels_[below].offset(child)];
            });
        });
    }
}

void clip_to_cell(std::vector<CellPiece>& pieces, std::vector<CellPiece>& spare) {
    for (int axis = 0; axis < 3; ++axis) {
        for (const double level : {0.0, 1.0}) {
            const double sign = 1 - 2 * level;
            const bool cuts =
                std::any_of(pieces.begin(), pieces.end(), [&](const CellPiece& piece) {
                    return std::any_of(piece.corners.begin(), piece.corners.end(),
                                       [&](const auto& p) { return sign * (p[axis] - level) < 0; });
                });
            if (!cuts) continue;
            spare.clear();
            for (const CellPiece& piece : pieces) add_part(piece, axis, level, sign, spare);
            pieces.swap(spare);
        }
    }
}

TrilinearPolynomial::TrilinearPolynomial(const std::array<double, 8>& corner_values)
    : c(corner_values) {
    for (std::size_t bit = 1; bit < 8; bit *= 2) {
        for (std::size_t i = 0; i < 8; ++i) {
            if (i & bit) c[i] -= c[i - bit];
        }
    }
}

double TrilinearPolynomial::at(const glm::dvec3& p) const {
    const double bottom = c[0] + p.x * c[1] + p.y * (c[2] + p.x * c[3]);
    const double slope = c[4] + p.x * c[5] + p.y * (c[6] + p.x * c[7]);
    return bottom + p.z * slope;
}

glm::dvec3 TrilinearPolynomial::gradient(const glm::dvec3& p) const {
    return {c[1] + p.y * c[3] + p.z * (c[5] + p.y * c[7]),
            c[2] + p.x * c[3] + p.z * (c[6] + p.x * c[7]),
            c[4] + p.x * c[5] + p.y * (c[6] + p.x * c[7])};
}

double TrilinearPolynomial::second_derivative(const glm::dvec3& p, const glm::dvec3& u,
                                              const glm::dvec3& v) const {
    return (u.x * v.y + u.y * v.x) * (c[3] + p.z * c[7]) +
           (u.x * v.z + u.z * v.x) * (c[5] + p.y * c[7]) +
           (u.y * v.z + u.z * v.y) * (c[6] + p.x * c[7]);
}

// Let b be the polar form of the cubic f (Ramshaw, Blossoming: a connect-the-dots approach to
// splines, 1987). The coefficients are b of three corners each, and
//   b(p, p, p + u)     = f(p) + f'(p) u / 3
//   b(p, p + u, p + v) = f(p) + f'(p) (u + v) / 3 + u^T f''(p) v / 6.
BernsteinCubic::BernsteinCubic(const TrilinearPolynomial& polynomial, const CellPiece& piece) {
    const auto& p = piece.corners;
    const auto& v = piece.values;
    std::array<glm::dvec3, 4> slope;
    for (std::size_t i = 0; i < 4; ++i) {
        trilinear[i] = polynomial.at(p[i]);
        slope[i] = polynomial.gradient(p[i]) / 3.0;
        difference[i] = trilinear[i] - v[i];
    }
    for (std::size_t edge = 0; edge < 6; ++edge) {
        const auto& [a, b] = tet_edges[edge];
        const glm::dvec3 along = p[b] - p[a];
        trilinear[4 + 2 * edge] = trilinear[a] + glm::dot(slope[a], along);
        trilinear[5 + 2 * edge] = trilinear[b] - glm::dot(slope[b], along);
        difference[4 + 2 * edge] = trilinear[4 + 2 * edge] - (2 * v[a] + v[b]) / 3;
        difference[5 + 2 * edge] = trilinear[5 + 2 * edge] - (v[a] + 2 * v[b]) / 3;
    }
    for (std::size_t face = 0; face < 4; ++face) {
        const auto& [a, b, c] = face_corners[face];
        const glm::dvec3 to_b = p[b] - p[a], to_c = p[c] - p[a];
        trilinear[16 + face] = trilinear[a] + glm::dot(slope[a], to_b + to_c) +
                               polynomial.second_derivative(p[a], to_b, to_c) / 6;
        difference[16 + face] = trilinear[16 + face] - (v[a] + v[b] + v[c]) / 3;
    }
}

double BernsteinCubic::largest() const {
    double bound = 0;
    for (const double d : difference) bound = std::max(bound, std::abs(d));
    return bound;
}

std::size_t BernsteinCubic::edge_to_halve(const CellPiece& piece) const {
    EdgeChoice most_bent, longest, steepest;
    double at_corners = 0;
    for (std::size_t corner = 0; corner < 4; ++corner) {
        at_corners = std::max(at_corners, std::abs(difference[corner]));
    }
    for (std::size_t edge = 0; edge < 6; ++edge) {
        const auto& [a, b] = tet_edges[edge];
        const double near_a = difference[4 + 2 * edge], near_b = difference[5 + 2 * edge];
        const glm::dvec3 along = piece.corners[b] - piece.corners[a];
        most_bent.offer(edge, std::max(std::abs(difference[a] - 2 * near_a + near_b),
                                       std::abs(near_a - 2 * near_b + difference[b])));
        longest.offer(edge, glm::dot(along, along));
        steepest.offer(edge, std::max(std::abs(trilinear[a] - trilinear[b]),
                                      std::abs(piece.values[a] - piece.values[b])));
    }
    const double gap = largest() - at_corners;
    // A bound at a corner is the known difference: narrow the ranges, which decide what is visible.
    if (gap < 0.01 * at_corners) return steepest.edge;
    // If the difference is nearly linear along all edges, the gap comes from inside the faces.
    return most_bent.score > 0.25 * gap ? most_bent.edge : longest.edge;
}

}  // namespace lamina
