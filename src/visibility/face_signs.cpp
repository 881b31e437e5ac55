// SPDX-License-Identifier: Apache-2.0
#include "visibility/face_signs.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

namespace lamina {
namespace {

// A determinant of three rounded differences is off by less than 8 half ulps of its permanent
// (Shewchuk 1997, section 4.3), which is at most 6 times the cube of the largest coordinate. The
// bound is twice that, so that its own rounding does not matter.
constexpr double error_bound = 96 * (std::numeric_limits<double>::epsilon() / 2);

double largest(const glm::dvec3& v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

}  // namespace

// The four faces share their vectors from the eye and two cross products.
FaceSigner::Rounded FaceSigner::rounded(const Tet& tet) const {
    std::array<glm::dvec3, 4> p;
    double reach = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        p[i] = points_[static_cast<std::size_t>(tet[i])] - eye_.position;
        reach = std::max(reach, largest(p[i]));
    }
    const glm::dvec3 p01 = glm::cross(p[0], p[1]), p23 = glm::cross(p[2], p[3]);
    return {{glm::dot(p[1], p23), -glm::dot(p[0], p23), glm::dot(p[3], p01), -glm::dot(p[2], p01)},
            error_bound * reach * reach * reach};
}

FaceSigner::Rounded FaceSigner::rounded_at_infinity(const Tet& tet) const {
    const glm::dvec3& d = eye_.position;
    const glm::dvec3& origin = points_[static_cast<std::size_t>(tet[0])];
    std::array<glm::dvec3, 3> p;
    double reach = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        p[i] = points_[static_cast<std::size_t>(tet[i + 1])] - origin;
        reach = std::max(reach, largest(p[i]));
    }
    const glm::dvec3 d1 = glm::cross(d, p[0]), d3 = glm::cross(d, p[2]);
    const double d12 = glm::dot(d1, p[1]), d13 = glm::dot(d1, p[2]), d23 = -glm::dot(d3, p[1]);
    // Face 0 is the sum of three determinants. Its bound is used for all faces.
    return {{d12 + d23 - d13, -d23, d13, -d12}, 4 * error_bound * largest(d) * reach * reach};
}

int FaceSigner::exact(const Tet& tet, std::size_t face) const {
    const auto [a, b, c] = corners_of_face(tet, face);
    return sign_as_seen(eye_, points_[static_cast<std::size_t>(a)],
                        points_[static_cast<std::size_t>(b)], points_[static_cast<std::size_t>(c)]);
}

// There are no branches on the signs, because these cannot be predicted.
FaceSigns FaceSigner::signs(std::size_t index) const {
    const Tet& tet = tets_[index];
    const Rounded seen = eye_.at_infinity ? rounded_at_infinity(tet) : rounded(tet);
    FaceSigns nearer = 0, farther = 0;
    for (std::size_t face = 0; face < 4; ++face) {
        const double value = seen.determinants[face];
        nearer |= FaceSigns{-value > seen.error} << face;
        farther |= FaceSigns{value > seen.error} << face;
    }
    if ((nearer | farther) != 0xf) {
        for (std::size_t face = 0; face < 4; ++face) {
            if ((nearer | farther) & nearer_bit(face)) continue;
            const int sign = exact(tet, face);
            nearer |= FaceSigns{sign < 0} << face;
            farther |= FaceSigns{sign > 0} << face;
        }
    }
    return nearer | farther * farther_bit(0);
}

}  // namespace lamina
