// SPDX-License-Identifier: Apache-2.0
#include "visibility/seen_box.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "mesh/predicates.h"

namespace lamina {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

// Points whose tangent from the middle of the view is larger than this count as behind the eye.
constexpr double widest = 1e3;

}  // namespace

SeenBoxes::SeenBoxes(const Eye& eye, const glm::dvec3& center)
    : at_infinity_(eye.at_infinity), origin_(eye.at_infinity ? center : eye.position) {
    const glm::dvec3 towards = eye.at_infinity ? eye.position : center - eye.position;
    const glm::dvec3 size = glm::abs(towards);
    const double largest = std::max({size.x, size.y, size.z});
    const glm::dvec3 along = largest > 0 ? glm::normalize(towards / largest) : glm::dvec3(0, 0, 1);
    const glm::dvec3 other = size.x < largest ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 across = glm::normalize(glm::cross(other, along));
    axes_ = {across, glm::cross(along, across), along};
}

// A coordinate is off by at most 4 epsilon of the distance (1-norm: three roundings of products,
// two of sums, one of the difference, and axes no longer than 1 + epsilon, which need not be
// exactly across one another: any axes will do). A quotient is off by that of both, as a share of
// the depth.
FaceTree::Box SeenBoxes::of(const Triangle& triangle) const {
    FaceTree::Box box = FaceTree::nothing();
    for (const glm::dvec3& corner : triangle) {
        const glm::dvec3 from = corner - origin_;
        const double distance = norm1(from);
        glm::dvec3 seen(glm::dot(from, axes_[0]), glm::dot(from, axes_[1]),
                        glm::dot(from, axes_[2]));
        glm::dvec3 slack(8 * epsilon * distance);
        if (!at_infinity_) {
            if (!(seen.z * widest > distance)) return {glm::dvec3(-INFINITY), glm::dvec3(INFINITY)};
            const double share = distance / seen.z;
            seen.x /= seen.z;
            seen.y /= seen.z;
            slack.x = slack.y = 16 * epsilon * share * (1 + share);
        }
        box.add({seen - slack, seen + slack});
    }
    return box;
}

}  // namespace lamina
