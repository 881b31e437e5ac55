// SPDX-License-Identifier: Apache-2.0
#include "optics/segment_integral.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "optics/opacity.h"

namespace lamina {
namespace {

// Returns the worst difference from piece_weights() over p and q from 0 to `most`, evenly in the
// table's own coordinates.
double worst(double most) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(0, 1);
    double worst = 0;
    for (int i = 0; i < 100000; ++i) {
        const double x = uniform(random) * (1 - 1 / (1 + most));
        const double y = uniform(random) * (1 - 1 / std::sqrt(1 + most));
        const double p = x / (1 - x), q = 1 / ((1 - y) * (1 - y)) - 1;
        const double error = FrontWeightTable::get().lookup(p, q) - piece_weights(p, q).front;
        worst = std::max(worst, std::abs(error));
    }
    return worst;
}

// Returns the worst difference of a polynomial, whose largest error is at the corners and sides of
// the triangle of p and q.
template <typename Weight>
double worst_below(double depth, const Weight& weight) {
    double worst = 0;
    for (int i = 0; i <= 300; ++i) {
        for (int j = 0; j <= 300 - i; ++j) {
            const double p = 2 * depth * i / 300, q = 2 * depth * j / 300;
            worst = std::max(worst, std::abs(weight(p, q) - piece_weights(p, q).front));
        }
    }
    return worst;
}

// Measures the errors that optics/segment_integral.h promises.
TEST(ThinFrontWeight, KeepsTheErrorStatedForIt) {
    EXPECT_LE(worst_below(faint_depth, faint_front_weight), 3e-7);
    const double worst = worst_below(thin_depth, thin_front_weight);
    EXPECT_LE(worst, 3e-5);
    EXPECT_EQ(thin_front_weight(0, 0), 0);
}

// Measures the errors that optics/segment_integral.h promises. Bilinear interpolation is off by up
// to h^2 / 8 times the second derivatives, which are of order 1 where p and q are small (h = 1 /
// 255: 2e-6 times their sum); elsewhere by less than the change of the weight over one cell of the
// table.
TEST(FrontWeightTable, KeepsTheErrorStatedForIt) {
    EXPECT_LE(worst(20), 2e-5);
    EXPECT_LE(worst(1e12), 5e-4);
}

// In the first cell of the table the weight, about p / 3 + q / 6, is interpolated from its corners,
// whose slopes are off by half of the second derivatives (.54 in x = p, .8 in y = q / 2) times h =
// 1 / 255: by .27 h p + .2 h q, at most .54 h = 2.12e-3 of the opacity, (p + q) / 2.
TEST(FrontWeightTable, HasASmallRelativeErrorInFaintPieces) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> exponent(-14, -2.5);
    double worst = 0;
    for (int i = 0; i < 10000; ++i) {
        const double p = std::pow(10, exponent(random)), q = std::pow(10, exponent(random));
        const double off = FrontWeightTable::get().lookup(p, q) - piece_weights(p, q).front;
        worst = std::max(worst, std::abs(off) / opacity_from_depth(p / 2 + q / 2));
    }
    EXPECT_LE(worst, 2.2e-3);
}

TEST(FrontWeightTable, IsRightAtZeroAndHugeDepths) {
    const FrontWeightTable& table = FrontWeightTable::get();
    EXPECT_EQ(table.lookup(0, 0), 0);
    EXPECT_NEAR(table.lookup(1e30, 0), 1, 1e-6);
    EXPECT_NEAR(table.lookup(0, 1e30), 1, 1e-6);
    EXPECT_NEAR(table.lookup(1e30, 1e30), 1, 1e-6);
    for (const double depth : {1e-12, 1e-6, 1e-3, 1.0, 100.0}) {
        EXPECT_NEAR(table.lookup(depth, 0), piece_weights(depth, 0).front, 2e-5);
        EXPECT_NEAR(table.lookup(0, depth), piece_weights(0, depth).front, 2e-5);
    }
}

}  // namespace
}  // namespace lamina
