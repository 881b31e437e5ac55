// SPDX-License-Identifier: Apache-2.0
#include "reference/cut.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "fixtures.h"
#include "optics/segment_integral.h"
#include "reference/composite.h"

namespace lamina {
namespace {

using reference_test::Random;

constexpr double machine_epsilon = std::numeric_limits<double>::epsilon();

// Makes a function with these knots, none on a line with its neighbours; every fifth interval shows
// nothing.
TransferFunction function_of(const std::vector<double>& knots, std::size_t shift) {
    std::vector<TransferKnot> given;
    for (std::size_t i = 0; i < knots.size(); ++i) {
        const double extinction = (i + shift) % 5 < 2 ? 0 : 1 + static_cast<double>(i * i % 7);
        given.push_back({knots[i], {{1, .5, static_cast<double>(i % 2)}, extinction}});
    }
    return TransferFunction::linear(given);
}

std::vector<std::vector<double>> sets_of_knots() {
    std::vector<double> crowded{-1000};
    for (int i = 0; i < 40; ++i) crowded.push_back(.001 * i);
    crowded.push_back(1000);
    Random random(9);
    std::vector<double> any;
    for (int i = 0; i < 300; ++i) any.push_back(random.uniform(-1, 1));
    std::ranges::sort(any);
    return {{3},
            {0, 1},
            {-5, 2, 2, 7, 7, 9},
            {1e15, 1e15 + 1, 1e15 + 2, 1e15 + 9},
            {-1e-300, 0, 1e-300},
            {0, 1e-310},
            {-3e290, 1e290, 1e290, 2e290, 4e290},
            {1e-290, 2e-290, 2e-290, 5e-290},
            crowded,
            any};
}

// Returns the pieces of a segment, front to back.
std::vector<std::size_t> pieces_of(const PieceBatch& pieces, std::int64_t segment) {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < pieces.count; ++i)
        if (pieces.segment[i] == segment) found.push_back(i);
    return found;
}

double lower(const TransferIntervals& intervals, std::int64_t interval) {
    return intervals.columns().bounds[static_cast<std::size_t>(interval)];
}
double upper(const TransferIntervals& intervals, std::int64_t interval) {
    return intervals.columns().bounds[static_cast<std::size_t>(interval) + 1];
}

// Expects that the pieces meet at knots or where the scalar turns, that nothing shows between
// pieces that do not, and that each piece stays in its interval, up to `rounding` of the scalar.
void expect_pieces(const Cubic& cubic, const TransferFunction& function,
                   const TransferIntervals& intervals, const PieceBatch& pieces,
                   const std::vector<std::size_t>& numbers, double rounding) {
    double at = 0;
    const auto expect_empty = [&](double from, double to) {
        for (int i = 1; i < 8 && to - from > 1e-9; ++i) {
            const double value = cubic(from + (to - from) * i / 8);
            bool empty = false;
            for (int place = -16; place <= 16; ++place)
                empty = empty || function.at(value + rounding * place / 16).extinction == 0;
            EXPECT_TRUE(empty) << value;
        }
    };
    for (const std::size_t i : numbers) {
        ASSERT_LT(pieces.from[i], pieces.to[i]);
        ASSERT_GE(pieces.from[i], at);
        expect_empty(at, pieces.from[i]);
        at = pieces.to[i];
        EXPECT_NEAR(pieces.start[i], cubic(pieces.from[i]), rounding);
        EXPECT_NEAR(pieces.end[i], cubic(pieces.to[i]), rounding);
        for (int part = 0; part <= 8; ++part) {
            const double t = pieces.from[i] + (pieces.to[i] - pieces.from[i]) * part / 8;
            EXPECT_GE(cubic(t), lower(intervals, pieces.interval[i]) - rounding);
            EXPECT_LE(cubic(t), upper(intervals, pieces.interval[i]) + rounding);
        }
    }
    ASSERT_LE(at, 1);
    expect_empty(at, 1);
}

// Returns a value of the function's range, often a knot, or a double next to one.
double value_near(const std::vector<double>& knots, double width, Random& random) {
    const double knot = knots[static_cast<std::size_t>(random.below(int(knots.size())))];
    switch (random.below(6)) {
        case 0:
            return knot;
        case 1:
            return std::nextafter(knot, -INFINITY);
        case 2:
            return std::nextafter(knot, INFINITY);
        default:
            return knots.front() + width * random.uniform(-.2, 1.2);
    }
}

void test_pieces(std::size_t shift, Random& random) {
    for (const std::vector<double>& knots : sets_of_knots()) {
        std::size_t made = 0;
        const TransferFunction function = function_of(knots, shift);
        const TransferIntervals intervals(function);
        const double width = std::max(knots.back() - knots.front(), 1e-300);
        for (int batch = 0; batch < 60; ++batch) {
            SegmentBatch segments;
            std::vector<Cubic> cubics;
            const int count = 1 + random.below(static_cast<int>(SegmentBatch::capacity));
            for (int i = 0; i < count; ++i) {
                // Random Bernstein coefficients, which bound the cubic.
                double b[4];
                for (double& each : b) each = value_near(knots, width, random);
                if (i % 4 == 1) b[1] = b[0] + (b[3] - b[0]) / 3, b[2] = b[3] - (b[3] - b[0]) / 3;
                if (i % 8 == 2) b[0] = b[1] = b[2] = b[3] = knots[knots.size() / 2];
                const Cubic cubic{{b[0], 3 * (b[1] - b[0]), 3 * (b[2] - 2 * b[1] + b[0]),
                                   b[3] - 3 * b[2] + 3 * b[1] - b[0]}};
                cubics.push_back(cubic);
                segments.add(cubic, *std::ranges::min_element(b), *std::ranges::max_element(b), 1);
            }
            // append_pieces() must not look behind the last segment.
            for (std::size_t i = cubics.size(); i < SegmentBatch::capacity; ++i) {
                segments.lo[i] = segments.hi[i] = INFINITY;
                for (auto& coefficients : segments.scalar) coefficients[i] = INFINITY;
            }
            PieceBatch pieces;
            append_pieces(segments, intervals, 0, pieces);
            made += pieces.count;
            // Rounding: sums of four numbers up to 10 times the largest value.
            const double rounding = 40 * machine_epsilon * (std::abs(knots.front()) + 2 * width);
            for (std::size_t i = 0; i < cubics.size(); ++i) {
                expect_pieces(cubics[i], function, intervals, pieces,
                              pieces_of(pieces, static_cast<std::int64_t>(i)), rounding);
            }
        }
        const auto shows = [](const TransferKnot& knot) { return knot.optics.extinction > 0; };
        EXPECT_EQ(std::ranges::any_of(function.knots(), shows), made > 0);
    }
}

TEST(SegmentPieces, TileTheirSegmentsInIntervals) {
    Random random(3);
    for (const std::size_t shift : {0, 2, 4}) test_pieces(shift, random);
}

// If a constant scalar is a knot, the interval above the knot counts.
TEST(SegmentPieces, ConstantsOnStepsTakeTheIntervalAbove) {
    const TransferFunction function = TransferFunction::linear(
        {{0, {{1, 1, 1}, 1}}, {2, {{1, 1, 1}, 3}}, {2, {{1, 1, 1}, 7}}, {5, {{1, 1, 1}, 8}}});
    const TransferIntervals intervals(function);
    SegmentBatch segments;
    segments.add({{2}}, 1, 2, 1);  // in a cell with other values
    segments.add({{2}}, 2, 2, 1);
    PieceBatch pieces;
    append_pieces(segments, intervals, 0, pieces);
    ASSERT_EQ(pieces.count, 2u);
    for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(pieces.depth[i], 7);
}

// Depths of linear segments must equal their closed form: the pieces that are cut from them lose no
// digits.
TEST(SegmentPieces, DepthEqualsTheClosedForm) {
    Random random(5);
    for (int i = 0; i < 2000; ++i) {
        const TransferFunction function = reference_test::random_function(
            random, random.below(4), random.below(4), std::pow(10, random.uniform(-3, 3)));
        const TransferIntervals intervals(function);
        const double front = random.uniform(), back = random.uniform();
        RayIntegrator integrator(intervals, 1e-6);
        integrator.begin(1);
        SegmentBatch alone;
        alone.add({{front, back - front}}, std::min(front, back), std::max(front, back), 1);
        integrator.add(alone);
        const SegmentIntegral expected = integrate_segment(function, front, back, 1);
        // Roots have errors of some epsilons of the scalars divided by their difference. Depth is
        // off by as much, times the largest extinction.
        const double moved = 16 * machine_epsilon / std::abs(back - front) * 2e3;
        if (integrator.opaque()) continue;  // the rest is not added
        EXPECT_NEAR(integrator.optical_depth(), expected.optical_depth,
                    1e-13 * expected.optical_depth + moved);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(integrator.color()[c], expected.color[c],
                        integrator.error_estimate() + 1e-13 + moved);
    }
}

}  // namespace
}  // namespace lamina
