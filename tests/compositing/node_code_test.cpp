// SPDX-License-Identifier: Apache-2.0
// Codes of a node's optical depth: docs/numerics.md, section 4.
#include "compositing/codes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace lamina {
namespace {

constexpr std::array every_code = {NodeCode::minimax, NodeCode::phi, NodeCode::alpha};
constexpr std::array shares = {1.0, .5, 1.0 / 3, 1.0 / 32, 1.0 / 1000, 1.0 / 1024, 1.0 / 65536};

TEST(NodeCode, DecodesWhatItEncodes) {
    for (const NodeCode code : every_code) {
        for (const double share : shares) {
            double previous = 0;
            for (double depth = 1e-9; depth < 20; depth *= 1.07) {
                const double value = encode_depth(code, depth, share);
                ASSERT_GE(value, previous) << "codes rise with depth";
                ASSERT_LE(value, 1);
                previous = value;
                // A value near 1 is rounded by 2^-53 and a little more, and so is its distance from
                // 1: e^-S, or e^-sigma for phi. The error of the depth is that times the slope of
                // the decoder, the inverse of this distance. For minimax another factor, its
                // divisor times e, is at most 8.
                const double exponent = code == NodeCode::phi ? depth / share : depth;
                const double slope = code == NodeCode::phi ? share : 1;
                if (exponent > 30) continue;  // the value is 1, except for rounding
                EXPECT_NEAR(decode_depth(code, value, share), depth,
                            depth * 1e-13 + slope * std::exp(exponent) * 4e-15)
                    << static_cast<int>(code) << " " << share;
            }
        }
    }
}

TEST(NodeCode, EncodesClearAs0AndOpaqueAs1) {
    for (const NodeCode code : every_code) {
        for (const double share : shares) {
            EXPECT_EQ(encode_depth(code, 0, share), 0);
            EXPECT_EQ(decode_depth(code, 0, share), 0);
            EXPECT_EQ(decode_depth(code, 1, share), opaque_node_depth);
            // 1 - e^-37 is 1 in double; minimax's division may change the last place.
            EXPECT_NEAR(encode_depth(code, opaque_node_depth, share), 1, 4e-16);
            EXPECT_LE(encode_depth(code, opaque_node_depth, share), 1);
            for (double value = 0; value <= 1; value += 1.0 / 4096) {
                const double depth = decode_depth(code, value, share);
                EXPECT_TRUE(depth >= 0 && depth <= opaque_node_depth) << value;
            }
        }
    }
}

// If a node holds the entire ray, minimax has nothing to balance and equals the paper's code.
TEST(NodeCode, MinimaxOfAWholeRayIsPhi) {
    for (double depth = 1e-9; depth < 50; depth *= 1.3) {
        const double phi = encode_depth(NodeCode::phi, depth, 1);
        EXPECT_NEAR(encode_depth(NodeCode::minimax, depth, 1), phi, 4e-16 + phi * 4e-16);
    }
}

// The three pieces of the minimax code meet, with equal slopes (docs/numerics.md, section 4).
TEST(NodeCode, MinimaxIsSmooth) {
    for (const double share : {.5, 1.0 / 32, 1.0 / 1024}) {
        for (const double joint : {share, 1.0}) {
            const double step = joint * 1e-5;
            const auto value = [&](double depth) {
                return encode_depth(NodeCode::minimax, depth, share);
            };
            const double before = (value(joint) - value(joint - step)) / step;
            const double after = (value(joint + step) - value(joint)) / step;
            // Slopes at places that are 1e-5 of the joint apart differ by this distance times the
            // curvature, which is as large as the slope over the joint.
            EXPECT_NEAR(before, after, 2e-5 * before) << share << " " << joint;
        }
    }
}

// The formulas of docs/numerics.md, section 4, with each piece written as its addition to the one
// before.
TEST(NodeCode, MinimaxFollowsTheFormulaOfNumerics) {
    constexpr double e = std::numbers::e;
    for (const double w : shares) {
        const double y = 1 + std::log(1 / w) / e;
        for (double sigma = 1e-3; sigma < 30 / w; sigma *= 1.1) {
            double expected = (1 - std::exp(-sigma)) / y;
            if (sigma > 1) expected = ((1 - 1 / e) + std::log(sigma) / e) / y;
            if (sigma > 1 / w) {
                expected = ((1 - 1 / e) + std::log(1 / w) / e + (1 - std::exp(1 - w * sigma)) / e);
                expected /= y;
            }
            // The bound is for some ten operations on numbers up to y.
            EXPECT_NEAR(encode_depth(NodeCode::minimax, w * sigma, w), expected, 2e-15);
        }
    }
}

// Returns the worst change of a ray's opacity, in 1/255, by rounding one value to 8 bits. The value
// is that of one node of the given share. The rounded depth counts once (the rest of the ray is
// transparent), or up to 1 / share times (all nodes are alike).
double worst_effect(NodeCode code, double share) {
    double worst = 0;
    const auto compare = [&](double value, double rounded) {
        const double depth = decode_depth(code, value, share);
        const double other = decode_depth(code, rounded, share);
        for (double nodes = 1; nodes <= 1 / share; nodes *= 1.005) {
            worst = std::max(worst, std::abs(std::exp(-nodes * depth) - std::exp(-nodes * other)));
        }
        worst = std::max(worst, std::abs(std::exp(-depth / share) - std::exp(-other / share)));
    };
    for (int k = 0; k < 255; ++k) {
        const double middle = (k + .5) / 255;  // as far as a value can be from codes k and k + 1
        compare(middle, k / 255.0);
        compare(middle, (k + 1) / 255.0);
    }
    return 255 * worst;
}

// The numbers are those of the table of docs/numerics.md, section 4. Each code is worst elsewhere:
// phi at its last half code, with one node; alpha at its first, with all nodes; minimax is equally
// bad everywhere.
TEST(NodeCode, RoundingHasTheWorstEffectsStatedInNumerics) {
    EXPECT_NEAR(worst_effect(NodeCode::phi, 1.0 / 32), 210, .5);
    EXPECT_NEAR(worst_effect(NodeCode::alpha, 1.0 / 32), 15.5, .05);
    EXPECT_NEAR(worst_effect(NodeCode::minimax, 1.0 / 32), 1.14, .005);
    EXPECT_NEAR(worst_effect(NodeCode::phi, 1.0 / 1024), 253, .5);
    EXPECT_NEAR(worst_effect(NodeCode::alpha, 1.0 / 1024), 221, .5);
    EXPECT_NEAR(worst_effect(NodeCode::minimax, 1.0 / 1024), 1.77, .006);
    for (const double share : {1.0, .25, 1.0 / 32, 1.0 / 1024}) {
        EXPECT_NEAR(worst_effect(NodeCode::phi, share), 255 * std::pow(510, -share), 1e-9);
        EXPECT_NEAR(worst_effect(NodeCode::alpha, share),
                    255 * (1 - std::pow(1 - 1 / 510.0, 1 / share)), 1e-9);
        // The formula is right to first order in half a code; the next order is 1/510 of it, of
        // unknown sign.
        const double y = 1 + std::log(1 / share) / std::numbers::e;
        EXPECT_NEAR(worst_effect(NodeCode::minimax, share), y / 2, y / 510);
    }
}

}  // namespace
}  // namespace lamina
