// SPDX-License-Identifier: Apache-2.0
#include "plan/voxel_faces.h"

#include <cmath>

#include "scene/camera.h"

namespace lamina {
namespace {

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

}  // namespace

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

}  // namespace lamina
