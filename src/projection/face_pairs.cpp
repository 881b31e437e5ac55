// SPDX-License-Identifier: Apache-2.0
#include "projection/face_pairs.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace lamina {
namespace {

// Distance by which polygons reach beyond the picture, because rounded corners there must not
// uncover a pixel's centre.
constexpr double guard = 2;  // pixels

// Distance below which two corners count as one.
constexpr double same = 1e-9;  // pixels

// Shares of the corners of a face that is seen edge-on.
constexpr glm::dvec3 nowhere(0, 0, -1);

}  // namespace

// The ray z (x, y, 1) of a place meets the face a, b, c if it is a positive combination of the
// three. The share of a is det(ray, b, c) / det(a, b, c), over z (Olano and Greer 1997, section 3;
// this holds with corners behind the eye, too). For parallel rays areas take the place of volumes.
// right, up, forward are left-handed, so the divisor is positive for fronts.
FacePairs::FacePairs(const WindowView& window, double near_depth, const Tet& tet,
                     const std::array<glm::dvec3, 4>& seen, const Fronts& fronts)
    : window_(window), near_depth_(near_depth), seen_(seen), fronts_(fronts) {
    const bool perspective = window.perspective();
    // All faces of the edge, in all tets, get the same numbers up to their sign.
    const auto edge = [&](std::size_t i, std::size_t j) {
        const double sign = tet[i] < tet[j] ? 1 : -1;
        if (tet[i] > tet[j]) std::swap(i, j);
        const glm::dvec3 &p = seen[i], &q = seen[j];
        if (perspective) return sign * glm::cross(p, q);
        return sign * glm::dvec3(p.y - q.y, q.x - p.x, p.x * q.y - p.y * q.x);
    };
    for (std::size_t face = 0; face < 4; ++face) {
        const auto& [a, b, c] = face_corners[face];
        const std::array<Linear, 3> opposite{edge(b, c), edge(c, a), edge(a, b)};
        const glm::dvec3 at = perspective ? seen[a] : glm::dvec3(seen[a].x, seen[a].y, 1);
        const double sign = fronts[face] ? 1 : -1, volume = sign * glm::dot(opposite[0], at);
        // A face through the eye is not met, because rays begin inside the tet.
        any_front_ = any_front_ || (fronts[face] && volume > 0);
        for (std::size_t i = 0; i < 3; ++i) {
            shares_[face][i] = volume > 0 ? opposite[i] / volume * sign : nowhere;
        }
        const glm::dvec3 normal = glm::cross(seen[b] - seen[a], seen[c] - seen[a]);
        inside_[face] = normal / glm::dot(normal, seen[face] - seen[a]);
        inside_at_eye_[face] = -glm::dot(inside_[face], seen[a]);
        cut_ = cut_ || seen[face].z < near_depth;
    }
    const glm::dvec2 lo(-guard), hi = 2.0 * window.middle() + guard;
    picture_ = {4, {lo, glm::dvec2(hi.x, lo.y), hi, glm::dvec2(lo.x, hi.y)}};
}

glm::dvec3 FacePairs::ray_at(const glm::dvec2& place) const {
    return {(place - window_.middle()) * window_.view().pixel, 1};
}

// Returns the part on which the function is not negative (Sutherland and Hodgman 1974).
FacePairs::Polygon FacePairs::cut(const Polygon& polygon, const Linear& function) const {
    Polygon part;
    const auto add = [&](const glm::dvec2& corner) {
        const auto near = [&](const glm::dvec2& other) {
            return glm::distance(corner, other) < same;
        };
        if (part.count > 0 && near(part.corners[part.count - 1])) return;
        if (part.count < most_corners) part.corners[part.count++] = corner;
    };
    for (std::size_t i = 0; i < polygon.count; ++i) {
        const glm::dvec2 &a = polygon.corners[i], &b = polygon.corners[(i + 1) % polygon.count];
        const double at_a = glm::dot(function, ray_at(a)), at_b = glm::dot(function, ray_at(b));
        if (at_a >= 0) add(a);
        if ((at_a < 0) != (at_b < 0)) add(a + at_a / (at_a - at_b) * (b - a));
    }
    if (part.count > 1 && glm::distance(part.corners[0], part.corners[part.count - 1]) < same)
        --part.count;
    if (part.count < 3) part.count = 0;
    return part;
}

FacePairs::Polygon FacePairs::part_of(std::size_t face, const Polygon& polygon) const {
    Polygon part = polygon;
    for (const Linear& share : shares_[face]) {
        if (part.count > 0) part = cut(part, share);
    }
    return part;
}

// 1/z, or z of parallel rays: values below 0 are farther.
FacePairs::Linear FacePairs::depth_of(std::size_t face) const {
    Linear depth(0);
    for (std::size_t i = 0; i < 3; ++i) {
        const double scale = window_.perspective() ? 1 : seen_[face_corners[face][i]].z;
        depth += scale * shares_[face][i];
    }
    return depth;
}

// Returns the part in which rays meet the face behind the near plane, or in front of it.
FacePairs::Polygon FacePairs::limited(const Polygon& polygon, std::size_t face,
                                      bool behind_near) const {
    if (!cut_ || polygon.count == 0) return polygon;
    const bool perspective = window_.perspective();
    const Linear beyond = perspective ? Linear(0, 0, 1 / near_depth_) - depth_of(face)
                                      : depth_of(face) - Linear(0, 0, near_depth_);
    return cut(polygon, behind_near ? beyond : -beyond);
}

FacePairs::Hit FacePairs::hit(std::size_t face, const glm::dvec2& place) const {
    const glm::dvec3 ray = ray_at(place);
    const bool perspective = window_.perspective();
    Hit hit{1, near_depth_, {}};
    if (face == near_plane) {
        if (perspective) hit.inverse_z = 1 / near_depth_;
        const glm::dvec3 along = perspective ? ray : glm::dvec3(ray.x, ray.y, near_depth_);
        for (std::size_t i = 0; i < 4; ++i)
            hit.shares[i] =
                std::max(glm::dot(inside_[i], along) + inside_at_eye_[i] * hit.inverse_z, 0.0);
        return hit;
    }
    double sum = 0, z = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t corner = face_corners[face][i];
        hit.shares[corner] = std::max(glm::dot(shares_[face][i], ray), 0.0);
        sum += hit.shares[corner];
        z += hit.shares[corner] * seen_[corner].z;
    }
    hit.inverse_z = perspective ? sum : 1;
    hit.z = perspective ? 1 / sum : z;
    return hit;
}

}  // namespace lamina
