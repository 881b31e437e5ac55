// SPDX-License-Identifier: Apache-2.0
#include "reference/cut.h"

#include <gtest/gtest.h>

#include "fixtures.h"

namespace lamina {
namespace {

using reference_test::Random;

Cubic random_cubic(Random& random) {
    Cubic cubic;
    for (double& c : cubic.c) c = random.uniform(-4, 4);
    for (std::size_t i = 1; i < 4; ++i) cubic.c[i] *= random.below(4) > 0;
    return cubic;
}

TEST(Cubic, IsMonotoneBetweenTurns) {
    Random random(1);
    for (int i = 0; i < 5000; ++i) {
        Cubic cubic = random_cubic(random);
        const double scale = i % 3 == 0 ? 1 : i % 3 == 1 ? 1e-290 : 1e290;
        for (double& c : cubic.c) c *= scale;
        const CubicTurns turns = turns_of(cubic);
        ASSERT_EQ(turns.t[0], 0);
        ASSERT_EQ(turns.t[turns.count], 1);
        for (int number = 0; number < turns.count; ++number) {
            const double from = turns.t[number], to = turns.t[number + 1];
            ASSERT_LT(from, to);
            const double direction = cubic(to) - cubic(from);
            for (int k = 0; k < 20; ++k) {
                const double a = from + (to - from) * k / 20, b = from + (to - from) * (k + 1) / 20;
                // Values are about 10: differences are good to some 1e-14.
                EXPECT_GE((cubic(b) - cubic(a)) * (direction < 0 ? -1 : 1), -1e-14 * scale);
            }
        }
    }
}

TEST(Cubic, SolveFindsTheValue) {
    Random random(2);
    for (int i = 0; i < 5000; ++i) {
        const Cubic cubic = random_cubic(random);
        const CubicTurns turns = turns_of(cubic);
        const int number = random.below(turns.count);
        const double from = turns.t[number], to = turns.t[number + 1];
        const double value = cubic(random.uniform(from, to));
        const double t = solve_monotone(cubic, value, from, to);
        EXPECT_GE(t, from);
        EXPECT_LE(t, to);
        EXPECT_NEAR(cubic(t), value, 8e-15);  // rounding of sums of up to 16
    }
}

TEST(Cubic, SolveIsPreciseNearATangency) {
    // (t - 1/2)^2 = v: close to the vertex the root is 1/2 -+ sqrt(v).
    const Cubic parabola{{0.25, -1, 1, 0}};
    for (const double v : {1e-4, 1e-8, 1e-12, 1e-15}) {
        const double root = std::sqrt(v);
        const double tolerance = 2.3e-16 / root + 2.3e-16;  // rounding of the value over the slope
        EXPECT_NEAR(solve_monotone(parabola, v, 0, 0.5), 0.5 - root, tolerance);
        EXPECT_NEAR(solve_monotone(parabola, v, 0.5, 1), 0.5 + root, tolerance);
    }
    // An inflection with slope 0: (t - 1/2)^3 = v.
    const Cubic inflected{{-0.125, 0.75, -1.5, 1}};
    const double t = solve_monotone(inflected, 0, 0, 1);
    EXPECT_NEAR(t, 0.5, 1e-5);  // cube root of the rounding of the value, 1e-16
}

TEST(Cubic, HasTheGivenEndsWhenRestricted) {
    Random random(4);
    for (int i = 0; i < 1000; ++i) {
        const Cubic cubic = random_cubic(random);
        const double from = random.uniform(0, 0.5), to = random.uniform(0.5, 1);
        const Cubic inside = restricted(cubic, from, to, cubic(from), cubic(to));
        EXPECT_EQ(inside(0), cubic(from));
        for (const double t : {0.25, 0.5, 1.0}) {
            EXPECT_NEAR(inside(t), cubic(from + t * (to - from)), 1e-14);  // sums of up to 16
        }
    }
}

}  // namespace
}  // namespace lamina
