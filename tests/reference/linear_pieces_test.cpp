// SPDX-License-Identifier: Apache-2.0
#include "reference/integrate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "fixtures.h"
#include "optics/segment_integral.h"
#include "reference/transfer_intervals.h"

namespace lamina {
namespace {

using reference_test::Random;

// Makes a function whose colours and extinctions change at every knot; every fifth interval shows
// nothing.
TransferFunction function_of(const std::vector<double>& knots, Random& random) {
    std::vector<TransferKnot> given;
    for (std::size_t i = 0; i < knots.size(); ++i) {
        const double extinction = i % 5 < 2 ? 0 : std::pow(10, random.uniform(-9, 4));
        given.push_back({knots[i], {random.point(0, 1), extinction}});
    }
    return TransferFunction::linear(given);
}

struct SegmentResult {
    double depth = 0;
    glm::dvec3 color{0};
};

// Returns the result of each segment alone, summed from its pieces.
std::vector<SegmentResult> results_of(const LinearSegments& segments,
                                      const TransferIntervals& intervals) {
    LinearPieces pieces;
    append_linear_pieces(segments, intervals.columns(), pieces);
    std::vector<SegmentResult> results(segments.count);
    for (std::size_t i = 0; i < pieces.count; ++i) {
        double& depth = results[static_cast<std::size_t>(pieces.segment[i])].depth;
        pieces.before[i] = depth;
        depth += pieces.depth[i];
        if (i > 0) {
            EXPECT_LE(pieces.segment[i - 1], pieces.segment[i]);
        }
    }
    weigh_pieces(pieces);
    for (std::size_t i = 0; i < pieces.count; ++i) {
        const auto& [color, change] = intervals.color(static_cast<std::size_t>(pieces.interval[i]));
        results[static_cast<std::size_t>(pieces.segment[i])].color +=
            pieces.transmittance[i] * (pieces.opacity[i] * color + pieces.change[i] * change);
    }
    return results;
}

void test_segments(const std::vector<double>& knots, Random& random) {
    const TransferFunction function = function_of(knots, random);
    const TransferIntervals intervals(function);
    const double width = knots.back() - knots.front();
    const auto value = [&] {
        const double knot = knots[static_cast<std::size_t>(random.below(int(knots.size())))];
        return random.below(3) == 0 ? knot : knots.front() + width * random.uniform(-.2, 1.2);
    };
    for (int batch = 0; batch < 100; ++batch) {
        LinearSegments segments;
        const int count = 1 + random.below(static_cast<int>(LinearSegments::capacity));
        for (int i = 0; i < count; ++i) {
            const double front = value();
            segments.add(front, i % 4 == 0 ? front : value(), std::pow(10, random.uniform(-9, 3)));
        }
        const auto found = results_of(segments, intervals);
        for (std::size_t i = 0; i < segments.count; ++i) {
            const SegmentIntegral expected = integrate_segment(
                function, segments.front[i], segments.back[i], segments.length[i]);
            // Both results have errors of some 1e-13 of every component
            // (optics/segment_integral.h); for a colour that fades out it is 1e-13 of the opacity.
            // Sums of some 30 subnormal numbers are off by units of 5e-324.
            constexpr double subnormal = 30 * 5e-324;
            EXPECT_NEAR(found[i].depth, expected.optical_depth,
                        2e-13 * expected.optical_depth + subnormal);
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(found[i].color[c], expected.color[c],
                            2e-13 * expected.alpha + subnormal);
        }
    }
}

TEST(LinearPieces, EqualThoseOfSingleSegments) {
    Random random(5);
    std::vector<double> many;
    for (int i = 0; i < 300; ++i) many.push_back(random.uniform(-1, 1));
    std::ranges::sort(many);
    for (int round = 0; round < 5; ++round) {
        test_segments({3, 3.5}, random);
        test_segments({0, 1, 2, 3, 4, 5}, random);
        test_segments({-5, 2, 2, 7, 7, 9, 11, 11, 14}, random);
        test_segments({-1e-300, 0, 1e-300, 2e-300}, random);
        test_segments({-1, 0, 1e-310, 1}, random);
        test_segments({-3e290, 1e290, 1e290, 2e290, 4e290}, random);
        test_segments(many, random);
    }
}

// Tests a function of one interval, with depths from 1e-300 to 1e3, up to where the weights have a
// closed form.
TEST(LinearPieces, WeightsEqualTheirClosedForm) {
    Random random(6);
    for (int i = 0; i < 5000; ++i) {
        const double p = i % 7 == 0 ? 0 : std::pow(10, random.uniform(-300, 3));
        const double q = i % 5 == 0   ? 0
                         : i % 2 == 0 ? p * random.uniform(0, 2)
                                      : std::pow(10, random.uniform(-12, 3));
        if (p + q == 0) continue;
        const TransferIntervals intervals(
            TransferFunction::linear({{0, {{0, 0, 0}, p}}, {1, {{1, 1, 1}, q}}}));
        LinearSegments segments;
        segments.add(0, 1, 1);
        LinearPieces pieces;
        append_linear_pieces(segments, intervals.columns(), pieces);
        ASSERT_EQ(pieces.count, 1U);
        weigh_pieces(pieces);
        const PieceWeights expected = piece_weights(p, q);
        // SIMD exponential functions have errors of 4 units in the last place, and all terms are >=
        // 0. Near the closed form the sum of both weights is one of two numbers < 1.
        EXPECT_NEAR(pieces.change[0], expected.back, 3e-15 * expected.back);
        EXPECT_NEAR(pieces.opacity[0], expected.front + expected.back,
                    4e-15 * (expected.front + expected.back));
        EXPECT_EQ(pieces.depth[0], p / 2 + q / 2);
    }
}

// Interpolation may overflow to infinity: such ends lie behind the last knot.
TEST(LinearPieces, PlaceInfiniteScalarsOutsideAllKnots) {
    for (const int count : {2, 24, 25, 256}) {
        std::vector<TransferKnot> knots;
        for (int i = 0; i < count; ++i) knots.push_back({1. * i, {{1, .1 * (i % 2), 1}, 2}});
        const TransferIntervals intervals(TransferFunction::linear(knots));
        LinearSegments segments;
        segments.add(INFINITY, INFINITY, 3);
        segments.add(-INFINITY, -INFINITY, 3);
        LinearPieces pieces;
        append_linear_pieces(segments, intervals.columns(), pieces);
        ASSERT_EQ(pieces.count, 2U);
        EXPECT_EQ(pieces.interval[0], count);
        EXPECT_EQ(pieces.interval[1], 0);
        EXPECT_EQ(pieces.depth[0], 6);
        EXPECT_EQ(pieces.depth[1], 6);
    }
}

}  // namespace
}  // namespace lamina
