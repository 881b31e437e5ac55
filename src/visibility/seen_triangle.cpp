// SPDX-License-Identifier: Apache-2.0
#include "visibility/seen_triangle.h"

#include <algorithm>

#include "mesh/predicates.h"
#include "visibility/face_signs.h"

namespace lamina {
namespace {

std::size_t after(std::size_t corner) {
    return corner == 2 ? 0 : corner + 1;
}

}  // namespace

SeenTriangle::SeenTriangle(const Eye& eye, const Triangle& corners) : corners_(corners) {
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec3& from = corners[i];
        edges_[i] = RoundedPlane(eye.at_infinity ? eye.position : from - eye.position,
                                 corners[after(i)] - from);
    }
    face_ = RoundedPlane(corners[1] - corners[0], corners[2] - corners[0]);
    sign_ = edge_sign(eye, 0, corners[2]);
}

int SeenTriangle::edge_sign(const Eye& eye, std::size_t corner, const glm::dvec3& point) const {
    const glm::dvec3 &from = corners_[corner], &to = corners_[after(corner)];
    if (const int sign = edges_[corner].sign(point - from)) return sign;
    // Most triangles that meet here share a corner.
    if (point == from || point == to) return 0;
    return sign_as_seen(eye, from, to, point);
}

int SeenTriangle::face_sign(const glm::dvec3& point) const {
    return side_of(corners_, face_, point);
}

// Returns 1 where all corners of `other` are on or outside this triangle's plane, -1 where they are
// on or inside, and 0 where they are on both sides.
int SeenTriangle::all_on_one_side(const SeenTriangle& other) const {
    bool outside = false, inside = false;
    for (const glm::dvec3& point : other.corners_) {
        const int sign = face_sign(point);
        outside |= sign > 0;
        inside |= sign < 0;
    }
    return !inside ? 1 : !outside ? -1 : 0;
}

// Returns whether all corners of `other` are on this triangle's side of the plane through the eye
// parallel to it, so that the two pyramids lie in one open half-space. It may wrongly return false.
bool SeenTriangle::sees_ahead(const Eye& eye, const SeenTriangle& other) const {
    if (eye.at_infinity) return true;
    return std::all_of(other.corners_.begin(), other.corners_.end(), [&](const glm::dvec3& point) {
        return face_.sign(point - eye.position) == sign_;
    });
}

bool SeenTriangle::separated_by_edge(const Eye& eye, const SeenTriangle& other) const {
    for (std::size_t edge = 0; edge < 3; ++edge) {
        // Rounded values come first: one corner that is surely on this side decides.
        std::array<int, 3> signs;
        for (std::size_t i = 0; i < 3; ++i)
            signs[i] = sign_ * edges_[edge].sign(other.corners_[i] - corners_[edge]);
        if (signs[0] > 0 || signs[1] > 0 || signs[2] > 0) continue;
        const auto beyond = [&](std::size_t i) {
            return signs[i] < 0 || sign_ * edge_sign(eye, edge, other.corners_[i]) <= 0;
        };
        if (beyond(0) && beyond(1) && beyond(2)) return true;
    }
    return false;
}

// Two triangles have no inner point in common if and only if a line along an edge of one of them
// separates them. The same holds for two pyramids in one half-space and planes along their faces.
// Otherwise the separating plane may hold one edge of each.
bool SeenTriangle::apart(const Eye& eye, const SeenTriangle& entry) const {
    if (separated_by_edge(eye, entry) || entry.separated_by_edge(eye, *this)) return true;
    if (sees_ahead(eye, entry)) return false;
    const Triangle &p = corners_, &q = entry.corners_;
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            const auto sign = [&](const glm::dvec3& point) {
                return sign_as_seen(eye, p[i], q[j], point);
            };
            const int p1 = sign(p[after(i)]), p2 = sign(p[after(after(i))]);
            const int q1 = sign(q[after(j)]), q2 = sign(q[after(after(j))]);
            if (p1 == 0 && p2 == 0 && q1 == 0 && q2 == 0) continue;
            if (p1 >= 0 && p2 >= 0 && q1 <= 0 && q2 <= 0) return true;
            if (p1 <= 0 && p2 <= 0 && q1 >= 0 && q2 >= 0) return true;
        }
    }
    return false;
}

bool SeenTriangle::shows(const Eye& eye, const SeenTriangle& entry) const {
    // An exit's face has its outside behind it, an entry's face before it. So where one triangle
    // lies on one side of the other's plane, equal signs mean the same order.
    const auto surely_before = [&](const glm::dvec3& point) {
        return face_.sign(point - corners_[0]) < 0;
    };
    const Triangle& q = entry.corners_;
    if (surely_before(q[0]) && surely_before(q[1]) && surely_before(q[2])) return false;
    if (apart(eye, entry)) return false;
    const int of_entry = all_on_one_side(entry);
    if (of_entry < 0) return false;
    if (of_entry > 0) return true;
    const int of_exit = entry.all_on_one_side(*this);
    return of_exit != 0 ? of_exit > 0 : behind_where_mixed(eye, entry);
}

// Returns whether the entry is behind at a corner of the part seen through the triangle. Such
// corners are corners of either triangle inside the other, and crossings of edges.
bool SeenTriangle::behind_where_mixed(const Eye& eye, const SeenTriangle& entry) const {
    const auto inside = [&](const SeenTriangle& triangle, const glm::dvec3& point) {
        for (std::size_t i = 0; i < 3; ++i) {
            if (triangle.edge_sign(eye, i, point) * triangle.sign_ < 0) return false;
        }
        return true;
    };
    for (const glm::dvec3& point : entry.corners_) {
        if (face_sign(point) > 0 && inside(*this, point)) return true;
    }
    for (const glm::dvec3& point : corners_) {
        if (entry.face_sign(point) > 0 && inside(entry, point)) return true;
    }
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec3 &a = corners_[i], &b = corners_[after(i)];
        for (std::size_t j = 0; j < 3; ++j) {
            const glm::dvec3 &c = entry.corners_[j], &d = entry.corners_[after(j)];
            const int side_c = edge_sign(eye, i, c);
            // Of two edges that cross before the eye, c -> d passes from one side of a -> b to the
            // other in the opposite sense to that of a -> b and c -> d; behind it, in the same.
            if (side_c == 0 || edge_sign(eye, i, d) != -side_c) continue;
            if (entry.edge_sign(eye, j, a) != -side_c || entry.edge_sign(eye, j, b) != side_c)
                continue;
            if (side_c * orientation(a, b, c, d) > 0) return true;
        }
    }
    return false;
}

SeenThrough::SeenThrough(const SeenTriangle& exit, const FaceTree::Box& bounds) {
    sides_[0] = PlaneSide(exit.face_, exit.corners_[0], bounds);
    for (std::size_t i = 0; i < 3; ++i)
        sides_[i + 1] = PlaneSide(exit.edges_[i], exit.corners_[i], bounds);
}

}  // namespace lamina
