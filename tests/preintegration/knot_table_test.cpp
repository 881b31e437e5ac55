// SPDX-License-Identifier: Apache-2.0
#include "preintegration/preintegration_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "base/error.h"
#include "optics/opacity.h"
#include "support/transfer_functions.h"

namespace lamina {
namespace {

using test::knot;
using test::peak_and_step;
using test::smooth;

TransferFunction narrow_peak() {
    return TransferFunction::linear({knot(0, glm::dvec3(0), 0), knot(0.5, glm::dvec3(1, 0.5, 0), 0),
                                     knot(0.503, glm::dvec3(1, 0.8, 0.2), 60),
                                     knot(0.506, glm::dvec3(0, 0.5, 1), 0),
                                     knot(1, glm::dvec3(1), 0.5)});
}

TransferFunction step() {
    return TransferFunction::linear(
        {knot(0, glm::dvec3(1, 0, 0), 0), knot(0.4, glm::dvec3(1, 0, 0), 1),
         knot(0.4, glm::dvec3(0, 0, 1), 5), knot(1, glm::dvec3(0, 1, 0), 8)});
}

double color_error(const SegmentIntegral& a, const SegmentIntegral& b) {
    double worst = 0;
    for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(a.color[c] - b.color[c]));
    return worst;
}

// Returns what the table stores for two of its nodes and one of its lengths.
SegmentIntegral entry(const KnotTable& table, std::size_t front, std::size_t back,
                      std::size_t layer) {
    const std::size_t count = table.nodes.size(), i = back * count + front;
    SegmentIntegral result;
    result.optical_depth = double{table.mean_extinction[i]} * table.lengths[layer];
    result.alpha = opacity_from_depth(result.optical_depth);
    if (table.mean_extinction[i] == 0) return result;
    const float* const emission = &table.emission[(layer * count * count + i) * 3];
    result.color = glm::dvec3(emission[0], emission[1], emission[2]) *
                   (result.alpha / table.mean_extinction[i]);
    return result;
}

// Tells whether both nodes are in one linear piece, or both are points of the transfer function.
bool is_looked_up(const KnotTable& table, std::size_t front, std::size_t back) {
    const auto is_anchor = [&](std::size_t node) {
        return std::ranges::find(table.anchors, static_cast<int>(node), &KnotTable::Anchor::node) !=
               table.anchors.end();
    };
    if (is_anchor(front) && is_anchor(back)) return true;
    const auto [lower, upper] = std::minmax(front, back);
    return std::ranges::none_of(table.anchors, [&](const KnotTable::Anchor& anchor) {
        const auto node = static_cast<std::size_t>(anchor.node);
        return lower < node && node < upper;
    });
}

TEST(KnotTable, IsExactAtItsNodes) {
    for (const auto& f : {smooth(), narrow_peak(), step()}) {
        const KnotTable table(f, {-0.25, 1.25, 3.0, 24, 4, true});
        const std::size_t count = table.nodes.size();
        for (std::size_t front = 0; front < count; ++front) {
            for (std::size_t back = 0; back < count; ++back) {
                // The two nodes of a step stand for its sides; a segment from one to the other
                // stands for neither.
                if (table.nodes[front] == table.nodes[back]) continue;
                if (!is_looked_up(table, front, back)) continue;
                for (std::size_t layer = 0; layer < table.lengths.size(); ++layer) {
                    const auto found = entry(table, front, back, layer);
                    const auto expected = integrate_segment(
                        f, table.nodes[front], table.nodes[back], table.lengths[layer]);
                    // Rounding: two floats of 6e-8 each and a few roundings.
                    EXPECT_NEAR(found.alpha, expected.alpha, 2e-7);
                    EXPECT_LE(color_error(found, expected), 5e-7)
                        << table.nodes[front] << " " << table.nodes[back] << " " << layer;
                }
            }
        }
    }
}

TEST(KnotTable, LookUpOnEqualScalarsIsTheHomogeneousSegment) {
    for (const auto& f : {smooth(), narrow_peak(), step()}) {
        const KnotTable table(f, {-0.25, 1.25, 3.0, 24, 4, true});
        for (const double value : table.nodes) {  // at a step: the later side's
            const auto found = table.lookup(value, value, 3);
            const auto expected = integrate_segment(f, value, value, 3);
            EXPECT_NEAR(found.alpha, expected.alpha, 2e-7);
            EXPECT_LE(color_error(found, expected), 5e-7) << value;
        }
    }
}

TEST(KnotTable, MeanExtinctionIsExactWithinALinearPiece) {
    const auto f = step();
    const KnotTable table(f, {0, 1, 2.0, 16, 1, true});
    std::mt19937 random(3);
    for (const auto& [lo, hi] : {std::pair(0.0, 0.4 - 1e-12), {0.4, 1.0}}) {
        std::uniform_real_distribution<double> inside(lo, hi);
        for (int i = 0; i < 1000; ++i) {
            const double front = inside(random), back = inside(random);
            const double expected = integrate_segment(f, front, back, 1.5).optical_depth;
            // Rounding: floats (6e-8) of numbers up to the cell's largest corner, which near
            // extinction 0 is not small compared with the result. Hence the second term: one float
            // rounding of extinction 1 times the length.
            EXPECT_NEAR(table.lookup(front, back, 1.5).optical_depth, expected,
                        1e-6 * expected + 1e-7);
        }
    }
}

TEST(KnotTable, DoesNotMixTheSidesOfAStep) {
    const auto f =
        TransferFunction::nearest({knot(0, glm::dvec3(1, 0, 0), 1), knot(1, glm::dvec3(0, 1, 0), 5),
                                   knot(2, glm::dvec3(0, 0, 1), 0)});
    const KnotTable table(f, {0, 2, 1.0, 9, 3, true});
    for (const double d : {1e-12, 1e-3, 0.1}) {
        const auto below = table.lookup(0.5 - d, 0.5 - d / 2, 1);
        const auto above = table.lookup(0.5 + d / 2, 0.5 + d, 1);
        EXPECT_NEAR(below.alpha, -std::expm1(-1), 1e-7);
        EXPECT_NEAR(above.alpha, -std::expm1(-5), 1e-7);
        EXPECT_EQ(below.color.g, 0);
        EXPECT_EQ(above.color.r, 0);
        EXPECT_EQ(table.lookup(1.5 + d / 2, 1.5 + d, 1).alpha, 0);
    }
}

TEST(KnotTable, EveryKnotIsANodeAndEveryIntervalHasAnInnerOne) {
    const auto f = narrow_peak();
    const TableRequest request{0.1, 0.9, 1.0, 8, 1, true};
    const KnotTable table(f, request);
    for (const double value : {0.1, 0.5, 0.503, 0.506, 0.9}) {
        EXPECT_EQ(std::ranges::count(table.nodes, value), 1) << value;
    }
    EXPECT_TRUE(std::ranges::is_sorted(table.nodes));
    ASSERT_EQ(table.anchors.size(), 5u);
    for (std::size_t a = 0; a + 1 < table.anchors.size(); ++a) {
        EXPECT_GE(table.anchors[a + 1].node - table.anchors[a].node, 2);
        EXPECT_EQ(table.nodes[table.anchors[a].node], table.anchors[a].value);
    }
    EXPECT_LE(table.nodes.size(), 12u + 3 * (3 + 1));
    const KnotTable stepped(step(), request);
    EXPECT_EQ(std::ranges::count(stepped.nodes, 0.4), 2);
    ASSERT_EQ(stepped.anchors.size(), 4u);
    EXPECT_EQ(stepped.anchors[2].node, stepped.anchors[1].node + 1);
}

TEST(KnotTable, TakesEmptyRangesZeroLengthsAndOneColor) {
    const auto f = step();
    const KnotTable point(f, {0.7, 0.7, 1.0, 256, 2, true});
    EXPECT_EQ(point.nodes.size(), 1u);
    const auto expected = integrate_segment(f, 0.7, 0.7, 0.5);
    EXPECT_NEAR(point.lookup(0.7, 0.7, 0.5).alpha, expected.alpha, 1e-6);
    EXPECT_LE(color_error(point.lookup(0.7, 0.7, 0.5), expected), 1e-6);

    const KnotTable flat(f, {0, 1, 0.0, 32, 3, true});
    EXPECT_EQ(flat.lookup(0.1, 0.9, 0).alpha, 0);

    const auto gray =
        TransferFunction::linear({knot(0, glm::dvec3(1), 0), knot(1, glm::dvec3(1), 2)});
    const KnotTable alone(gray, {0, 1, 1.0, 32, 1, false});
    EXPECT_TRUE(alone.emission.empty());
    const auto found = alone.lookup(0.2, 0.9, 3);
    EXPECT_NEAR(found.alpha, -std::expm1(-1.1 * 3), 1e-6);
    EXPECT_EQ(found.color.g, found.alpha);
}

// Largest errors, in 1/255, over random segments with small ranges of scalars, as slabs have them.
struct WorstErrors {
    double alpha = 0, color = 0;
};

WorstErrors worst_errors(const TransferFunction& f) {
    constexpr double longest = 0.1;
    const KnotTable table(f, {0, 1, longest, 256, 8, true});
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(0, 1);
    WorstErrors worst;
    for (int i = 0; i < 4000; ++i) {
        const double front = unit(random), length = longest * unit(random);
        const double back = std::clamp(front + 0.2 * (unit(random) - 0.5), 0.0, 1.0);
        const auto expected = integrate_segment(f, front, back, length);
        const auto found = table.lookup(front, back, length);
        worst.alpha = std::max(worst.alpha, 255 * std::abs(found.alpha - expected.alpha));
        worst.color = std::max(worst.color, 255 * color_error(found, expected));
    }
    return worst;
}

TEST(KnotTable, InterpolatesAccuratelyAcrossKnots) {
    const WorstErrors of_smooth = worst_errors(smooth());
    const WorstErrors of_peak = worst_errors(narrow_peak());
    const WorstErrors of_step = worst_errors(step());
    // Opacity has only the errors of floats: three relative errors of 6e-8 of depth * exp(-depth)
    // <= 0.37.
    for (const auto& worst : {of_smooth, of_peak, of_step}) {
        EXPECT_LE(worst.alpha, 255 * 3 * 6e-8 * 0.37);
    }
    // Colour has errors by interpolation between nodes and between lengths. Limits: twice what was
    // measured.
    EXPECT_LE(of_smooth.color, 0.0015);
    EXPECT_LE(of_step.color, 0.001);
    EXPECT_LE(of_peak.color, 0.25);
}

TEST(KnotTable, RefusesTooManyPointsAndTooManyBytes) {
    std::vector<TransferKnot> knots;
    for (int i = 0; i < 1100; ++i) knots.push_back(knot(i, glm::dvec3(1), i % 2));
    const auto f = TransferFunction::linear(knots);
    EXPECT_THROW(KnotTable(f, {-1, 1101, 1.0, 256, 1, true}), Error);
    EXPECT_NO_THROW(KnotTable(f, {-1, 20, 1.0, 64, 2, true}));
    EXPECT_THROW(KnotTable(f, {0, 4, 1.0, 20000, 2, true}), Error);
}

// Between points that are one or two roundings apart no inner node fits.
TEST(KnotTable, NodesAscendThoughPointsAreOneRoundingApart) {
    for (const double gap : {0.0, 1e-16, 1e-12}) {
        const double below = std::nextafter(.7, 0) - gap;
        const auto transfer_function = TransferFunction::linear(
            {{.1, {{1, 0, 0}, 1}}, {below, {{0, 1, 0}, 2}}, {.7, {{0, 0, 1}, 3}}});
        TableRequest request;
        request.lo = .1;
        request.hi = .7;
        request.length_layers = 4;
        const KnotTable table(transfer_function, request);
        for (std::size_t i = 0; i + 1 < table.nodes.size(); ++i)
            EXPECT_LT(table.nodes[i], table.nodes[i + 1]);
        EXPECT_EQ(table.nodes.back(), .7);
    }
}

double largest_error(const FrontParts& a, const FrontParts& b) {
    double worst = std::abs(a.alpha - b.alpha);
    for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(a.color[c] - b.color[c]));
    return worst;
}

TableRequest lit_request(int nodes, int layers) {
    return {0, 1, .5, nodes, layers, true, true};
}

// The lengths are the table's own, so nothing is interpolated between them.
TEST(KnotTable, FrontPartsAreExactFromPointToPoint) {
    const auto f = peak_and_step();
    const KnotTable table(f, lit_request(24, 4));
    for (const auto& [one, other] : {std::pair(0., .3), {.3, .303}, {.303, .306}}) {
        for (const double length : {.5 / 3, 1. / 3, .5}) {
            for (const auto& [front, back] : {std::pair(one, other), {other, one}, {one, one}}) {
                const LitIntegral found = table.lookup_lit(front, back, length);
                const LitIntegral expected = integrate_lit_segment(f, front, back, length);
                // Errors: floats of 6e-8 in some ten operations, and 1e-8 of the moments.
                EXPECT_LE(largest_error(found.front, expected.front), 7e-7) << front << " " << back;
                EXPECT_NEAR(found.whole.alpha, expected.whole.alpha, 2e-7);
            }
        }
    }
}

double worst_front_error(const TransferFunction& f, int nodes, int layers) {
    const KnotTable table(f, lit_request(nodes, layers));
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(0, 1);
    double worst = 0;
    for (int i = 0; i < 3000; ++i) {
        const double front = unit(random), length = .5 * unit(random);
        const double back = std::clamp(front + .2 * (unit(random) - .5), 0., 1.);
        worst = std::max(worst, largest_error(table.lookup_lit(front, back, length).front,
                                              integrate_lit_segment(f, front, back, length).front));
    }
    return worst;
}

// Interpolation is linear in scalars and lengths, so with four times the nodes the error falls by
// 16; half of that is required, because other segments may be the worst. The first table's error is
// at most the square of a node's share of the range, some 1 / 32^2, times the changes of colours
// and extinctions.
TEST(KnotTable, FrontPartsConverge) {
    for (const auto& f : {smooth(), peak_and_step()}) {
        const double coarse = worst_front_error(f, 32, 5), fine = worst_front_error(f, 128, 17);
        EXPECT_LE(fine, coarse / 8);
        EXPECT_LE(fine, 1. / 255 / 4);
    }
}

TEST(KnotTable, UnlitTablesHaveNoFrontParts) {
    const KnotTable unlit(smooth(), {0, 1, .5, 32, 3, true});
    EXPECT_TRUE(unlit.front_parts.empty());
    const KnotTable lit(smooth(), lit_request(32, 3));
    EXPECT_FALSE(lit.front_parts.empty());
    EXPECT_EQ(lit.emission, unlit.emission);
    EXPECT_EQ(lit.mean_extinction, unlit.mean_extinction);
}

}  // namespace
}  // namespace lamina
