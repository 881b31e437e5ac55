// SPDX-License-Identifier: Apache-2.0
#include "model/transfer_curves.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace lamina::view {
namespace {

struct Ends {
    double lo, hi, linear;
};
constexpr Ends many[] = {{0, 1, .01},  {0, 1e7, 1e-4}, {0, 3e-9, 1e-12},
                         {-5, 20, .5}, {-1e6, -2, 3},  {0, 1, 1e6}};

TEST(SymlogAxis, PlacesGoFromEndToEnd) {
    for (const Ends& ends : many) {
        const SymlogAxis axis(ends.lo, ends.hi, ends.linear);
        EXPECT_EQ(axis.place(ends.lo), 0);
        EXPECT_EQ(axis.place(ends.hi), 1);
        EXPECT_EQ(axis.number(0), ends.lo);
        EXPECT_EQ(axis.number(1), ends.hi);
    }
}

TEST(SymlogAxis, NeverFalls) {
    for (const Ends& ends : many) {
        const SymlogAxis axis(ends.lo, ends.hi, ends.linear);
        double before = axis.place(ends.lo);
        double number = ends.lo;
        for (int i = 1; i <= 20000; ++i) {
            // Alternate between the next larger double and a number far from it.
            number = i % 2 == 0 ? std::nextafter(number, 1e300)
                                : ends.lo + (ends.hi - ends.lo) * (i / 20000.);
            const double here = axis.place(number);
            EXPECT_GE(here, before) << number;
            before = here;
        }
    }
}

TEST(SymlogAxis, IsItsOwnInverseWithinItsTolerance) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(0, 1);
    constexpr double e = 0x1p-53;
    for (const Ends& ends : many) {
        const SymlogAxis axis(ends.lo, ends.hi, ends.linear);
        const double most = std::max(std::abs(ends.lo), std::abs(ends.hi));
        for (int i = 0; i < 10000; ++i) {
            // Alternate between even and logarithmic spacing.
            const double share =
                i % 2 == 0 ? uniform(random) : std::pow(10., -12 * uniform(random));
            const double x = std::clamp(ends.lo + (ends.hi - ends.lo) * share, ends.lo, ends.hi);
            EXPECT_NEAR(axis.number(axis.place(x)), x,
                        8 * e * (1 + std::log1p(most / ends.linear)) * (std::abs(x) + ends.linear));
        }
    }
}

TEST(SymlogAxis, IsLinearNearZeroAndLogarithmicFarFromIt) {
    const SymlogAxis axis(0, 1e9, 1);
    // log1p(x) / x differs from 1 by x / 2.
    EXPECT_NEAR(axis.place(2e-6) / axis.place(1e-6), 2, 2e-6);
    // log1p(x) differs from ln x by 1 / x: 1e-3 of a step whose length is ln 10.
    EXPECT_NEAR((axis.place(1e5) - axis.place(1e4)) / (axis.place(1e4) - axis.place(1e3)), 1, 1e-3);
}

TEST(SymlogAxis, WritesFewPowersOfTen) {
    EXPECT_EQ(SymlogAxis(0, 2, .01).ticks(9), (std::vector<double>{0, .01, .1, 1}));
    const auto both = SymlogAxis(-50, 50, 1).ticks(9);
    EXPECT_EQ(both, (std::vector<double>{-10, -1, 0, 1, 10}));
    for (const Ends& ends : many) {
        for (int most = 3; most < 9; ++most)
            EXPECT_LE(SymlogAxis(ends.lo, ends.hi, ends.linear).ticks(most).size(),
                      static_cast<std::size_t>(most));
    }
}

}  // namespace
}  // namespace lamina::view
