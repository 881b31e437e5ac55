// SPDX-License-Identifier: Apache-2.0
#include "visibility/seen_shapes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include "mesh/predicates.h"
#include "visibility/order_graph.h"

namespace lamina {

namespace {

// Distance in pixels from the polygon up to which a pixel's centre counts as covered. It is more
// than rounding moves a corner by (coordinates up to 1e9 pixels, beside the near plane, are good to
// 1e-7), and more than the ray perturbation (1e-7).
constexpr double margin = 1e-3;

double signed_area(const SeenPolygon& polygon) {
    double sum = 0;
    for (std::size_t i = 2; i < polygon.count; ++i) {
        sum += cross(polygon.corners[i - 1] - polygon.corners[0],
                     polygon.corners[i] - polygon.corners[0]);
    }
    return 0.5 * sum;
}

// A range of columns or of rows, clamped to what a picture can have.
struct Range {
    double low = INFINITY, high = -INFINITY;
    void add(double value) {
        low = std::min(low, value);
        high = std::max(high, value);
    }
    std::int32_t first(std::int32_t least) const {
        return static_cast<std::int32_t>(
            std::clamp(std::ceil(low - margin), static_cast<double>(least), 0x1p30));
    }
    std::int32_t last(std::int32_t most) const {
        return static_cast<std::int32_t>(
            std::clamp(std::floor(high + margin), -0x1p30, static_cast<double>(most)));
    }
};

// The columns of a polygon between two rows.
Range columns_between(const SeenPolygon& polygon, double top, double bottom) {
    Range columns;
    for (std::size_t i = 0; i < polygon.count; ++i) {
        const glm::dvec2& a = polygon.corners[i];
        const glm::dvec2& b = polygon.corners[(i + 1) % polygon.count];
        if (a.y >= top && a.y <= bottom) columns.add(a.x);
        for (const double row : {top, bottom}) {
            if ((a.y < row) == (b.y < row)) continue;
            columns.add(a.x + (row - a.y) / (b.y - a.y) * (b.x - a.x));
        }
    }
    return columns;
}

// Calls visit(pixels) for each row of the area in which the polygon covers some, until it returns
// false.
template <typename Visit>
void for_each_row(const SeenPolygon& polygon, const PixelArea& area, const Visit& visit) {
    Range rows;
    for (std::size_t i = 0; i < polygon.count; ++i) rows.add(polygon.corners[i].y);
    const std::int32_t last = rows.last(area.last_row);
    for (std::int32_t row = rows.first(area.first_row); row <= last; ++row) {
        const Range columns = columns_between(polygon, row - margin, row + margin);
        const PixelArea pixels{columns.first(area.first_column), columns.last(area.last_column),
                               row, row};
        if (!pixels.empty() && !visit(pixels)) return;
    }
}

}  // namespace

double SeenPolygon::area() const {
    return std::abs(signed_area(*this));
}

glm::dvec2 PixelFinder::place_of(const glm::dvec3& seen) const {
    const glm::dvec2 window = window_.to_window(seen);
    return {window.x - 0.5, window_.view().height - 0.5 - window.y};
}

SeenPolygon PixelFinder::polygon(const Triangle& triangle) const {
    SeenPolygon seen;
    const std::array<glm::dvec3, 3> corners{window_.see(triangle[0]), window_.see(triangle[1]),
                                            window_.see(triangle[2])};
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec3 &a = corners[i], &b = corners[(i + 1) % 3];
        if (!window_.perspective() || a.z >= near_) seen.add(place_of(a));
        if (window_.perspective() && (a.z < near_) != (b.z < near_)) {
            glm::dvec3 at = a + (near_ - a.z) / (b.z - a.z) * (b - a);
            at.z = near_;
            seen.add(place_of(at));
        }
    }
    return seen;
}

PixelArea PixelFinder::pixels_of(std::span<const glm::dvec3> points) const {
    const PixelArea all{0, window_.view().width - 1, 0, window_.view().height - 1};
    Range columns, rows;
    std::size_t hidden = 0;
    for (const glm::dvec3& point : points) {
        const glm::dvec3 seen = window_.see(point);
        if (window_.perspective() && seen.z < near_) {
            ++hidden;
            continue;
        }
        const glm::dvec2 place = place_of(seen);
        columns.add(place.x);
        rows.add(place.y);
    }
    if (hidden == points.size()) return {0, -1, 0, -1};
    if (hidden > 0) return all;
    return {columns.first(0), columns.last(all.last_column), rows.first(0),
            rows.last(all.last_row)};
}

SeenPolygon overlap_of(const SeenPolygon& a, const SeenPolygon& b) {
    const double sign = signed_area(b) < 0 ? -1 : 1;
    SeenPolygon common = a;
    for (std::size_t i = 0; i < b.count; ++i) {
        const glm::dvec2& from = b.corners[i];
        const glm::dvec2 along = b.corners[(i + 1) % b.count] - from;
        common = cut(common, [&](const glm::dvec2& c) { return sign * cross(along, c - from); });
    }
    return common;
}

PixelArea covered_pixels(const SeenPolygon& polygon, const PixelArea& area) {
    PixelArea covered{0, -1, 0, -1};
    for_each_row(polygon, area, [&](const PixelArea& pixels) {
        covered.add(pixels);
        return true;
    });
    return covered;
}

bool covers_some(const SeenPolygon& polygon, const PixelArea& area) {
    bool some = false;
    for_each_row(polygon, area, [&](const PixelArea&) {
        some = true;
        return false;
    });
    return some;
}

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

// Returns 1 if all corners of `other` are on or outside this triangle's plane, -1 if they are
// on or inside, and 0 if they are on both sides.
int SeenTriangle::all_on_one_side(const SeenTriangle& other) const {
    bool outside = false, inside = false;
    for (const glm::dvec3& point : other.corners_) {
        const int sign = face_sign(point);
        outside |= sign > 0;
        inside |= sign < 0;
    }
    return !inside ? 1 : !outside ? -1 : 0;
}

// Tells whether all corners of `other` are on this triangle's side of the plane through the eye
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

// Tells whether two pyramids are apart. Two triangles have no inner point in common if and only if
// a line along an edge of one of them separates them; so it is with two pyramids in one half-space
// and planes along their faces. Otherwise the separating plane may hold one edge of each.
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
    // An exit's face has its outside behind it, an entry's face before it. So if one triangle lies
    // on one side of the other's plane, equal signs mean the same order.
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

// Tells whether the entry is behind at a corner of the part seen through the triangle. Such corners
// are corners of either triangle inside the other, and crossings of edges.
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
            // Two edges cross before the eye if c -> d passes from one side of a -> b to the other
            // in the opposite sense to that of a -> b and c -> d; they cross behind it if the
            // senses are the same.
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

namespace {

// A triangle cut by three planes has at most six corners.
struct Polygon {
    std::array<glm::dvec3, 6> corners;  // from the eye; at infinity from any common origin
    std::size_t count = 0;
    void add(const glm::dvec3& corner) {
        if (count < corners.size()) corners[count++] = corner;
    }
};

// Van Oosterom and Strackee, The solid angle of a plane triangle, 1983, equation 8.
double solid_angle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
    const double determinant = glm::dot(a, glm::cross(b, c));
    const double rest =
        la * lb * lc + glm::dot(a, b) * lc + glm::dot(a, c) * lb + glm::dot(b, c) * la;
    return 2 * std::abs(std::atan2(std::abs(determinant), rest));
}

double area(const Eye& eye, const Polygon& polygon) {
    double sum = 0;
    for (std::size_t i = 2; i < polygon.count; ++i) {
        const glm::dvec3 &a = polygon.corners[0], &b = polygon.corners[i - 1],
                         &c = polygon.corners[i];
        sum +=
            eye.at_infinity
                ? 0.5 * std::abs(glm::dot(glm::normalize(eye.position), glm::cross(b - a, c - a)))
                : solid_angle(a, b, c);
    }
    return sum;
}

Polygon from_eye(const Eye& eye, const Triangle& triangle, const glm::dvec3& origin) {
    Polygon polygon;
    for (const glm::dvec3& corner : triangle)
        polygon.add(corner - (eye.at_infinity ? origin : eye.position));
    return polygon;
}

}  // namespace

double seen_area(const Eye& eye, const Triangle& triangle) {
    return area(eye, from_eye(eye, triangle, triangle[0]));
}

double seen_overlap(const Eye& eye, const Triangle& exit, const Triangle& entry) {
    const Polygon window = from_eye(eye, exit, exit[0]);
    Polygon seen = from_eye(eye, entry, exit[0]);
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec3 &a = window.corners[i], &b = window.corners[(i + 1) % 3];
        const glm::dvec3 normal = glm::cross(eye.at_infinity ? eye.position : a, b - a);
        const double offset = glm::dot(normal, a);
        seen = cut(seen, [&](const glm::dvec3& c) { return glm::dot(normal, c) - offset; });
    }
    return area(eye, seen);
}

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

// Tangent of the angle from the middle of the view above which points count as behind the eye.
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
