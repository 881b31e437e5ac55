// SPDX-License-Identifier: Apache-2.0
#include "visibility/seen_area.h"

#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>

#include "visibility/polygon_cut.h"

namespace lamina {
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

}  // namespace lamina
