// SPDX-License-Identifier: Apache-2.0
#include "reference/seen_pixels.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "mesh/norm1.h"

namespace lamina {
namespace {

// Points whose tangent from the middle of the view is larger than this may be anywhere.
constexpr double widest = 1e3;

// A coordinate of a point, or of a line's place and direction, is off by at most some 8 epsilon of
// the distances (1-norm) between point, eye and origin. The rest is to spare.
constexpr double place_error = 64 * std::numeric_limits<double>::epsilon(), spare_pixels = 1e-6;
constexpr double least_error = 64 * std::numeric_limits<double>::denorm_min();

// How far the view's axes are from orthonormal: 1e-8 where `up` is nearly parallel to the view
// direction.
double skew_of(const View& view) {
    const auto off = [](const glm::dvec3& a, const glm::dvec3& b, double expected) {
        return std::abs(glm::dot(a, b) - expected);
    };
    return std::max({off(view.right, view.forward, 0), off(view.up, view.forward, 0),
                     off(view.right, view.up, 0), off(view.right, view.right, 1),
                     off(view.up, view.up, 1), off(view.forward, view.forward, 1)});
}

}  // namespace

// Points behind the eye are seen mirrored, so what lies on both sides of it may be anywhere.
SeenPixels pixels_around(const View& view, const PictureTile& tile,
                         std::span<const glm::dvec3> points) {
    const glm::ivec2 size(tile.width, tile.height);
    const SeenPixels all{{0, 0}, size - 1};
    const bool perspective = view.projection == Projection::perspective;
    const glm::dvec2 middle(0.5 * view.width - 0.5 - tile.column,
                            0.5 * view.height - 0.5 - tile.row);
    const double error = place_error + 8 * skew_of(view);
    glm::dvec2 least(INFINITY), most(-INFINITY);
    std::size_t behind = 0;
    for (const glm::dvec3& point : points) {
        const glm::dvec3 from = point - view.eye;
        const double distance = norm1(from), depth = glm::dot(from, view.forward);
        glm::dvec2 place(glm::dot(from, view.right), -glm::dot(from, view.up));
        double slack = error * (distance + norm1(view.eye)) + least_error;
        if (perspective) {
            if (!(std::abs(depth) * widest > distance)) return all;
            behind += depth < 0;
            place /= depth;
            slack *= (1 + distance / std::abs(depth)) / std::abs(depth);
        }
        place = place / view.pixel + middle;
        slack = slack / view.pixel + spare_pixels;
        if (!std::isfinite(place.x + place.y + slack)) return all;
        least = glm::min(least, place - slack);
        most = glm::max(most, place + slack);
    }
    if (behind != 0 && behind != points.size()) return all;
    return {glm::ivec2(glm::ceil(glm::clamp(least, glm::dvec2(0), glm::dvec2(size)))),
            glm::ivec2(glm::floor(glm::clamp(most, glm::dvec2(-1), glm::dvec2(size - 1))))};
}

}  // namespace lamina
