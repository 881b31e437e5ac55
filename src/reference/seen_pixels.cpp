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

TileSight::TileSight(const View& view, const PictureTile& tile)
    : view_(view),
      size_(tile.width, tile.height),
      middle_(0.5 * view.width - 0.5 - tile.column, 0.5 * view.height - 0.5 - tile.row),
      error_(place_error + 8 * skew_of(view)),
      eye_norm_(norm1(view.eye)) {}

// Points behind the eye are seen mirrored, so what lies on both sides of it may be anywhere.
SeenPixels TileSight::around(std::span<const glm::dvec3> points) const {
    const SeenPixels all{{0, 0}, size_ - 1};
    const bool perspective = view_.projection == Projection::perspective;
    glm::dvec2 least(INFINITY), most(-INFINITY);
    std::size_t behind = 0;
    for (const glm::dvec3& point : points) {
        const glm::dvec3 from = point - view_.eye;
        const double distance = norm1(from), depth = glm::dot(from, view_.forward);
        glm::dvec2 place(glm::dot(from, view_.right), -glm::dot(from, view_.up));
        double slack = error_ * (distance + eye_norm_) + least_error;
        if (perspective) {
            if (!(std::abs(depth) * widest > distance)) return all;
            behind += depth < 0;
            place /= depth;
            slack *= (1 + distance / std::abs(depth)) / std::abs(depth);
        }
        place = place / view_.pixel + middle_;
        slack = slack / view_.pixel + spare_pixels;
        if (!std::isfinite(place.x + place.y + slack)) return all;
        least = glm::min(least, place - slack);
        most = glm::max(most, place + slack);
    }
    if (behind != 0 && behind != points.size()) return all;
    return {glm::ivec2(glm::ceil(glm::clamp(least, glm::dvec2(0), glm::dvec2(size_)))),
            glm::ivec2(glm::floor(glm::clamp(most, glm::dvec2(-1), glm::dvec2(size_ - 1))))};
}

}  // namespace lamina
