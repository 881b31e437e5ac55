// SPDX-License-Identifier: Apache-2.0
#include "meshing/interpolation_error.h"

#include <atomic>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "base/client.h"
#include "base/parallel.h"

namespace lamina {
namespace {

using Cell = TrilinearField::Cell;
using Box = std::array<glm::dvec3, 2>;

constexpr double infinity = std::numeric_limits<double>::infinity();
// Ratio of the largest difference found to the bound at which the search ends. It is below 1: if
// the largest difference equals the tolerance, bounds would approach it without end.
constexpr double nearness = 0.98;
// Ratio, like nearness, that suffices once a violation is known and only its place is sought.
constexpr double nearness_to_insert = 0.8;
constexpr int deepest = 60;  // halvings of a piece: its size is then far below rounding
// Largest number of pieces that are examined in one cell. Further pieces count with their bounds.
constexpr int most_pieces = 20000;

// Flatness (MeasuredTet) above which the linear function, extrapolated, gives no useful bound.
constexpr double flattest = 1e4;

glm::dvec3 corner_of(const Box& box, std::size_t corner) {
    return {box[corner & 1].x, box[(corner >> 1) & 1].y, box[corner >> 2].z};
}

struct Affine {
    glm::dvec3 gradient{0};
    double constant = 0;

    double at(const glm::dvec3& p) const { return constant + glm::dot(gradient, p); }
    ValueRange over(const Box& box) const {
        const double middle = at(0.5 * (box[0] + box[1]));
        const double half = 0.5 * glm::dot(glm::abs(gradient), box[1] - box[0]);
        return {middle - half, middle + half};
    }
};

// A tet and its linear function. Places are relative to corner 0, to keep their digits.
struct MeasuredTet {
    glm::dvec3 origin{0};
    std::array<Affine, 4> barycentric;  // weights of the corners
    Affine value;
    ValueRange values;  // range of the corners' values
    Box bounds;
    double flatness = infinity;  // diagonal of bounds / least height; infinite: no volume

    MeasuredTet(const std::array<glm::dvec3, 4>& p, const std::array<double, 4>& f)
        : origin(p[0]), bounds{p[0], p[0]} {
        const glm::dvec3 b = p[1] - p[0], c = p[2] - p[0], d = p[3] - p[0];
        for (const glm::dvec3& corner : p) {
            bounds = {glm::min(bounds[0], corner), glm::max(bounds[1], corner)};
        }
        const auto [lo, hi] = std::minmax_element(f.begin(), f.end());
        values = {*lo, *hi};
        const double volume = glm::dot(glm::cross(b, c), d);
        if (volume == 0) return;
        barycentric[1].gradient = glm::cross(c, d) / volume;
        barycentric[2].gradient = glm::cross(d, b) / volume;
        barycentric[3].gradient = glm::cross(b, c) / volume;
        barycentric[0].constant = 1;
        value.constant = f[0];
        flatness = 0;
        const double length = glm::length(bounds[1] - bounds[0]);
        for (std::size_t i = 1; i < 4; ++i) {
            barycentric[0].gradient -= barycentric[i].gradient;
            value.gradient += (f[i] - f[0]) * barycentric[i].gradient;
        }
        for (const Affine& weight : barycentric) {
            flatness = std::max(flatness, length * glm::length(weight.gradient));
        }
    }

    Box relative(const Box& box) const { return {box[0] - origin, box[1] - origin}; }

    bool outside(const Box& relative_box) const {
        const double rounding = 1e-13 * (1 + flatness);
        return std::any_of(barycentric.begin(), barycentric.end(), [&](const Affine& weight) {
            return weight.over(relative_box).hi < -rounding;
        });
    }
    bool contains(const glm::dvec3& relative_point) const {
        return std::all_of(barycentric.begin(), barycentric.end(),
                           [&](const Affine& weight) { return weight.at(relative_point) >= 0; });
    }
    ValueRange over(const Box& relative_box) const {
        const ValueRange box = value.over(relative_box);
        return {std::max(box.lo, values.lo), std::min(box.hi, values.hi)};
    }
};

struct OpenCell {
    double bound;  // on the difference in the cell
    Cell cell;
};
struct OpenPiece {
    CellPiece piece;
    int depth;  // number of halvings
};
struct WorkingSpace {
    std::vector<OpenCell> cells;
    std::vector<std::pair<int, Cell>> blocks;
    std::vector<CellPiece> clipped, spare;
    std::vector<OpenPiece> pieces;
};

// Measures one tet. look_into_blocks() collects the cells that ranges do not decide. Then
// look_into_cell() bounds the difference in each, the cell of the largest bound first.
class Measurement {
  public:
    Measurement(const TrilinearField& field, const CellRanges& ranges,
                const TransferFunction* transfer_function, const std::array<glm::dvec3, 4>& corners,
                const std::array<double, 4>& values, double tolerance, ErrorGoal goal)
        : field_(field),
          ranges_(ranges),
          transfer_function_(transfer_function),
          corners_(corners),
          values_(values),
          tolerance_(tolerance),
          goal_(goal),
          tet_(corners, values) {}

    TetError run() {
        if (tet_.flatness == infinity) return {};
        static thread_local WorkingSpace space;
        look_into_blocks(space);
        if (goal_ == ErrorGoal::decide && violated()) {
            error_.bound = infinity;
            return error_;
        }
        std::sort(space.cells.begin(), space.cells.end(),
                  [](const OpenCell& a, const OpenCell& b) { return a.bound > b.bound; });
        for (const OpenCell& open : space.cells) look_into_cell(open, space);
        if (goal_ == ErrorGoal::decide && violated()) error_.bound = infinity;
        return error_;
    }

  private:
    // Returns the bound that needs no closer look: within tolerance, or near the found difference.
    double enough() const {
        const bool place_only = goal_ == ErrorGoal::decide && violated();
        return std::max(tolerance_, error_.found / (place_only ? nearness_to_insert : nearness));
    }
    bool violated() const { return error_.found > nearness * tolerance_; }
    bool decided(double bound) {
        if (bound > enough()) return false;
        error_.bound = std::max(error_.bound, bound);
        return true;
    }
    bool invisible(double lo, double hi) const {
        return transfer_function_ && transfer_function_->transparent(lo, hi);
    }
    // Records a difference. Places where the value is nearly visible count, too: bounds need not
    // follow exactly where visibility begins.
    void found(double trilinear, double linear, const glm::dvec3& place) {
        const double difference = std::abs(trilinear - linear);
        if (difference <= error_.found) return;
        const double margin = (1 - nearness) * tolerance_;
        if (invisible(std::min(trilinear, linear) - margin, std::max(trilinear, linear) + margin)) {
            return;
        }
        error_.found = difference;
        error_.place = place;
        error_.bound = std::max(error_.bound, difference);
    }
    bool decided(const ValueRange& trilinear, const ValueRange& linear) {
        const double bound = std::max(trilinear.hi - linear.lo, linear.hi - trilinear.lo);
        return decided(bound) ||
               invisible(std::min(trilinear.lo, linear.lo), std::max(trilinear.hi, linear.hi));
    }

    // Returns the tet's bounding box between plane first and plane last + 1 of each axis.
    Box box_of(const Cell& first, const Cell& last) const {
        Box box;
        for (int axis = 0; axis < 3; ++axis) {
            box[0][axis] = std::max(tet_.bounds[0][axis], field_.planes(axis)[first[axis]]);
            box[1][axis] = std::min(tet_.bounds[1][axis], field_.planes(axis)[last[axis] + 1]);
        }
        return box;
    }

    // Collects the cells that are not decided by the ranges of the blocks around them.
    void look_into_blocks(WorkingSpace& space) {
        space.cells.clear();
        space.blocks.clear();
        const Cell lowest = field_.cell_of(tet_.bounds[0]);
        Cell highest = field_.cell_of(tet_.bounds[1]);
        for (int axis = 0; axis < 3; ++axis) {  // leave out cells that the tet only touches
            const double plane = field_.planes(axis)[highest[axis]];
            if (highest[axis] > lowest[axis] && plane == tet_.bounds[1][axis]) --highest[axis];
        }
        const auto add_blocks = [&](int level, const Cell& first, const Cell& last) {
            for (std::int32_t z = first[2]; z <= last[2]; ++z) {
                for (std::int32_t y = first[1]; y <= last[1]; ++y) {
                    for (std::int32_t x = first[0]; x <= last[0]; ++x) {
                        space.blocks.push_back({level, {x, y, z}});
                    }
                }
            }
        };
        int level = 0;
        for (int axis = 0; axis < 3; ++axis) {
            while ((highest[axis] >> level) - (lowest[axis] >> level) > 1) ++level;
        }
        level = std::min(level, ranges_.levels());
        Cell first{}, last{};
        for (int axis = 0; axis < 3; ++axis) {
            first[axis] = lowest[axis] >> level;
            last[axis] = highest[axis] >> level;
        }
        add_blocks(level, first, last);
        while (!space.blocks.empty()) {
            const auto [at_level, block] = space.blocks.back();
            space.blocks.pop_back();
            if (at_level == 0) {
                look_at_cell(block, space.cells);
                continue;
            }
            for (int axis = 0; axis < 3; ++axis) {
                first[axis] = std::max(lowest[axis], block[axis] << at_level);
                last[axis] = std::min(highest[axis], ((block[axis] + 1) << at_level) - 1);
            }
            const Box box = tet_.relative(box_of(first, last));
            if (tet_.outside(box)) continue;
            if (decided(ranges_.of_block(at_level, block), tet_.over(box))) continue;
            for (int axis = 0; axis < 3; ++axis) {
                first[axis] >>= at_level - 1;
                last[axis] >>= at_level - 1;
            }
            add_blocks(at_level - 1, first, last);
        }
    }

    // Bounds the difference in a cell by its values at the corners of a box: the cell's part in the
    // tet's bounding box. Notes the cell in `open` if that does not decide.
    void look_at_cell(const Cell& cell, std::vector<OpenCell>& open) {
        const Box box = box_of(cell, cell);
        const Box relative = tet_.relative(box);
        if (tet_.outside(relative)) return;
        if (tet_.flatness > flattest) {
            open.push_back({infinity, cell});
            return;
        }
        glm::dvec3 lowest{0}, size{1};
        for (int axis = 0; axis < 3; ++axis) {
            lowest[axis] = field_.planes(axis)[cell[axis]];
            size[axis] = field_.planes(axis)[cell[axis] + 1] - lowest[axis];
        }
        const TrilinearPolynomial polynomial(field_.corners(cell));
        double bound = 0;
        ValueRange trilinear{infinity, -infinity};
        for (std::size_t corner = 0; corner < 8; ++corner) {
            const glm::dvec3 place = corner_of(box, corner),
                             from_origin = corner_of(relative, corner);
            const double value = polynomial.at((place - lowest) / size);
            const double linear = tet_.value.at(from_origin);
            trilinear = {std::min(trilinear.lo, value), std::max(trilinear.hi, value)};
            bound = std::max(bound, std::abs(value - linear));
            if (std::abs(value - linear) > error_.found && tet_.contains(from_origin)) {
                found(value, linear, place);
            }
        }
        const ValueRange linear = tet_.over(relative);
        bound = std::min(bound, std::max(trilinear.hi - linear.lo, linear.hi - trilinear.lo));
        if (decided(bound) || decided(trilinear, linear)) return;
        open.push_back({bound, cell});
    }

    // Bounds the difference on the intersection of tet and cell, by halving pieces of it.
    void look_into_cell(const OpenCell& open, WorkingSpace& space) {
        if (decided(open.bound)) return;
        glm::dvec3 lowest{0}, size{1};
        for (int axis = 0; axis < 3; ++axis) {
            lowest[axis] = field_.planes(axis)[open.cell[axis]];
            size[axis] = field_.planes(axis)[open.cell[axis] + 1] - lowest[axis];
        }
        CellPiece whole{corners_, values_};
        for (glm::dvec3& corner : whole.corners) corner = (corner - lowest) / size;
        space.clipped.assign(1, whole);
        clip_to_cell(space.clipped, space.spare);
        space.pieces.clear();
        for (const CellPiece& piece : space.clipped) space.pieces.push_back({piece, 0});

        const TrilinearPolynomial polynomial(field_.corners(open.cell));
        for (int count = 0; !space.pieces.empty(); ++count) {
            const auto [piece, depth] = space.pieces.back();
            space.pieces.pop_back();
            const BernsteinCubic cubic(polynomial, piece);
            for (std::size_t i = 0; i < 4; ++i) {
                found(cubic.trilinear[i], piece.values[i], lowest + piece.corners[i] * size);
            }
            const double bound = cubic.largest();
            if (decided(bound)) continue;
            const auto [t_lo, t_hi] =
                std::minmax_element(cubic.trilinear.begin(), cubic.trilinear.end());
            const auto [l_lo, l_hi] = std::minmax_element(piece.values.begin(), piece.values.end());
            if (invisible(std::min(*t_lo, *l_lo), std::max(*t_hi, *l_hi))) continue;
            if (depth == deepest || count > most_pieces) {
                error_.bound = std::max(error_.bound, bound);
                continue;
            }
            const auto& [a, b] = tet_edges[cubic.edge_to_halve(piece)];
            const glm::dvec3 middle = 0.5 * (piece.corners[a] + piece.corners[b]);
            const double value = 0.5 * (piece.values[a] + piece.values[b]);
            for (const std::size_t moved : {a, b}) {
                CellPiece half = piece;
                half.corners[moved] = middle;
                half.values[moved] = value;
                space.pieces.push_back({half, depth + 1});
            }
        }
    }

    const TrilinearField& field_;
    const CellRanges& ranges_;
    const TransferFunction* transfer_function_;
    const std::array<glm::dvec3, 4>& corners_;
    const std::array<double, 4>& values_;
    double tolerance_;
    ErrorGoal goal_;
    MeasuredTet tet_;
    TetError error_;
};

}  // namespace

TetError InterpolationError::measure(const std::array<glm::dvec3, 4>& corners,
                                     const std::array<double, 4>& values, double tolerance,
                                     ErrorGoal goal) const {
    return Measurement(field_, ranges_, transfer_function_, corners, values, tolerance, goal).run();
}

double InterpolationError::largest(std::span<const glm::dvec3> points,
                                   std::span<const double> values, std::span<const Tet> tets,
                                   double tolerance) const {
    Progress progress("measuring the error", std::ssize(tets));
    std::atomic<double> largest{0};
    parallel_for(std::ssize(tets), 256, [&](std::int64_t number) {
        const Tet& tet = tets[number];
        std::array<glm::dvec3, 4> corners;
        std::array<double, 4> corner_values;
        for (std::size_t corner = 0; corner < 4; ++corner) {
            corners[corner] = points[tet[corner]];
            corner_values[corner] = values[tet[corner]];
        }
        const TetError error = measure(corners, corner_values, tolerance, ErrorGoal::bound);
        double known = largest;
        while (known < error.bound && !largest.compare_exchange_weak(known, error.bound)) {
        }
        progress.advance();
    });
    return largest;
}

}  // namespace lamina
