// SPDX-License-Identifier: Apache-2.0
#include "plan/surface_error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "facts/drawn_range.h"
#include "optics/optics_change.h"
#include "optics/pieces.h"
#include "scene/camera.h"

namespace lamina {
namespace {

// The optics at a scalar. At a step there are two points of one scalar.
struct OpticsPoint {
    double value;
    OpticalProperties optics;
};

// Returns the ends of the transfer function's linear pieces in a range, in order.
std::vector<OpticsPoint> ends_of_pieces(const TransferFunction& transfer_function,
                                        const ValueRange& range) {
    std::vector<OpticsPoint> ends;
    for_each_linear_piece(transfer_function.knots(), range.lo, range.hi,
                          [&](const LinearPiece& piece) {
                              ends.push_back({piece.from, piece.at_from});
                              ends.push_back({piece.to, piece.at_to});
                          });
    return ends;
}

// Bounds on the changes between scalars that a rounding may exchange.
struct OpticsChanges {
    OpticsChange steps;  // at jumps, and on pieces that are no wider than steep_width roundings
    OpticsChange ramps;  // on wider pieces
};

OpticsChanges largest_changes(const std::vector<OpticsPoint>& ends, double rounding,
                              double length) {
    OpticsChange slopes, jumps, ramps;
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
        const double width = ends[i + 1].value - ends[i].value;
        if (width > rounding) {
            OpticsChange& found = width > steep_width * rounding ? ramps : slopes;
            found.enlarge(OpticsChange::between(ends[i].optics, ends[i + 1].optics, length,
                                                rounding / width));
        }
        for (std::size_t j = i + 1; j < ends.size() && ends[j].value - ends[i].value <= rounding;
             ++j)
            jumps.enlarge(OpticsChange::between(ends[i].optics, ends[j].optics, length, 1));
    }
    return {slopes + jumps, ramps};
}

// Distance of a ray from a face, in voxels, at which they count as meeting: far more than the
// roundings of places in double precision, and than those of coordinates with 9 digits in files.
constexpr double tie_distance = 1e-6;

// A number that is linear over the picture.
struct Linear {
    double constant, per_x, per_y;
};

// Tells whether test(value) holds at the center of a pixel. Axes along which the value hardly
// changes are not walked along.
template <typename Test>
bool holds_somewhere(const View& view, const Linear& value, double hardly, const Test& test) {
    const bool columns = std::abs(value.per_x) * view.width * view.pixel > hardly;
    const bool rows = std::abs(value.per_y) * view.height * view.pixel > hardly;
    for (int row = 0; row < (rows ? view.height : 1); ++row) {
        const double in_row = value.constant + (rows ? value.per_y * view.y(row) : 0);
        for (int column = 0; column < (columns ? view.width : 1); ++column) {
            if (test(in_row + (columns ? value.per_x * view.x(column) : 0))) return true;
        }
    }
    return false;
}

// Tells whether a pixel's ray runs in a face between two voxels.
bool rays_run_in_voxel_faces(const Scene& scene, const Facts& facts) {
    if (!(facts.far_depth > 0)) return false;
    const View view(*scene.camera, scene.width, scene.height);
    const Grid& grid = facts.grid;
    const glm::dvec3 eye = grid.to_index(view.eye), right = grid.direction_to_index(view.right),
                     up = grid.direction_to_index(view.up),
                     forward = grid.direction_to_index(view.forward);
    for (int axis = 0; axis < 3; ++axis) {
        const auto size = static_cast<double>(grid.size[static_cast<std::size_t>(axis)]);
        const auto on_face = [&](double place) {
            const double face = std::round(place);  // voxel i reaches from i to i + 1
            return face > 0 && face < size && std::abs(place - face) <= tie_distance;
        };
        const auto stays = [&](double direction) {
            return std::abs(direction) * facts.far_depth <= tie_distance;
        };
        const bool meets =
            view.projection == Projection::orthographic
                ? stays(forward[axis]) && holds_somewhere(view, {eye[axis], right[axis], up[axis]},
                                                          tie_distance / 8, on_face)
                : on_face(eye[axis]) &&
                      holds_somewhere(view, {forward[axis], right[axis], up[axis]},
                                      tie_distance / 8 / facts.far_depth, stays);
        if (meets) return true;
    }
    return false;
}

// If each voxel has one value, a rounding decides which of the two voxels at a face a ray in it
// sees.
SurfaceError error_in_voxel_faces(const Scene& scene, const Facts& facts) {
    if (facts.occupied.empty() || facts.constant || !rays_run_in_voxel_faces(scene, facts))
        return {};
    return {1, 1};
}

}  // namespace

SurfaceError surface_error(const Scene& scene, const Facts& facts) {
    if (facts.grid.lookup == VolumeLookup::nearest) return error_in_voxel_faces(scene, facts);
    const TransferFunction& transfer_function = *scene.transfer_function;
    const ValueRange window = exact_range(transfer_function, facts.range, facts.type);
    const double rounding = scalar_rounding * (window.hi - window.lo);
    // Steps at the least and at the largest sample count: rays may run in a face between equal
    // samples.
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const ValueRange shown{std::nextafter(facts.range.lo, -infinity),
                           std::nextafter(facts.range.hi, infinity)};
    const double length = std::min(box_diagonal(facts.grid), (facts.far_depth - facts.near_depth) *
                                                                 facts.max_length_per_depth);
    const OpticsChanges changes =
        largest_changes(ends_of_pieces(transfer_function, shown), rounding, length);
    return {changes.steps.of_ray(length), (changes.steps + changes.ramps).of_ray(length)};
}

}  // namespace lamina
