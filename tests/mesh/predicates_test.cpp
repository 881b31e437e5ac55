// SPDX-License-Identifier: Apache-2.0
#include "mesh/predicates.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace lamina {
namespace {

__extension__ using Wide = __int128;
struct Whole {
    std::int64_t x, y, z;
};

glm::dvec3 to_point(const Whole& w, double scale, const glm::dvec3& offset) {
    return glm::dvec3(static_cast<double>(w.x), static_cast<double>(w.y),
                      static_cast<double>(w.z)) *
               scale +
           offset;
}

// Computes the sign with 128-bit integers. It is exact: differences of whole numbers below 2^32
// give a determinant below 6 * 2^99.
int sign_by_integers(const Whole& a, const Whole& b, const Whole& c, const Whole& d) {
    const Wide ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z;
    const Wide vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
    const Wide wx = d.x - a.x, wy = d.y - a.y, wz = d.z - a.z;
    const Wide det = ux * (vy * wz - vz * wy) - uy * (vx * wz - vz * wx) + uz * (vx * wy - vy * wx);
    return det > 0 ? 1 : det < 0 ? -1 : 0;
}

TEST(Predicates, AgreeWithIntegersOnNearlyCoplanarPoints) {
    std::mt19937_64 random(1);
    std::uniform_int_distribution<std::int64_t> large(-(1LL << 30), 1LL << 30);
    std::uniform_int_distribution<std::int64_t> small(-3, 3);
    int zeros = 0, positive = 0;
    for (int i = 0; i < 200000; ++i) {
        const Whole a{large(random), large(random), large(random)};
        const Whole b{large(random), large(random), large(random)};
        const std::int64_t n = small(random), m = small(random);
        // c is near the line of a and b, and d near the plane of all, by a few units.
        const Whole c{a.x + small(random), a.y + small(random), a.z + small(random)};
        Whole d{a.x + n * (b.x - a.x) / 4 + m * (c.x - a.x),
                a.y + n * (b.y - a.y) / 4 + m * (c.y - a.y),
                a.z + n * (b.z - a.z) / 4 + m * (c.z - a.z)};
        d.x += small(random) / 3;
        const int expected = sign_by_integers(a, b, c, d);
        // Scaling by powers of two is exact.
        const auto at = [&](const Whole& w) { return to_point(w, 0x1p-40, glm::dvec3(0)); };
        ASSERT_EQ(orientation(at(a), at(b), at(c), at(d)), expected) << i;
        ASSERT_EQ(orientation(at(b), at(a), at(c), at(d)), -expected) << i;
        zeros += expected == 0;
        positive += expected > 0;
    }
    EXPECT_GT(zeros, 10000);  // enough points were exactly coplanar
    EXPECT_GT(positive, 10000);
}

// The differences of these coordinates are no doubles: the second component of each must count.
TEST(Predicates, SeeTheLastBitOfFarApartCoordinates) {
    const double tiny = 0x1p-60;
    const glm::dvec3 a(1, 1, 1), b(2, 1, 1), c(1, 2, 1);
    EXPECT_EQ(orientation(a, b, c, glm::dvec3(1.3, 1.4, 1)), 0);
    EXPECT_EQ(orientation(a, b, c, glm::dvec3(1.3, 1.4, std::nextafter(1.0, 2.0))), 1);
    // a0 = tiny: the difference 1 - tiny rounds to 1, and det is -tiny exactly.
    EXPECT_EQ(
        sign_of_determinant({1, 0, 0}, {0, 0, 0}, {0, 1, 0}, {0, 0, 0}, {1, 1, tiny}, {0, 0, tiny}),
        0);
    EXPECT_EQ(
        sign_of_determinant({1, 0, 1}, {0, 0, 0}, {0, 1, 0}, {0, 0, 0}, {1, 0, 1}, {tiny, 0, 0}),
        1);  // det = 1 - (1 - tiny)
}

}  // namespace
}  // namespace lamina
