// SPDX-License-Identifier: Apache-2.0
#include "optics/segment_integral.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <string>

namespace lamina {
namespace {

// Relative error that `lamina integrate` promises for every component (README.md).
constexpr double promised = 1e-12;

double relative_error(double found, double expected) {
    if (found == expected) return 0;
    return std::abs(found - expected) / std::abs(expected);
}

TransferFunction transfer_function_of(const nlohmann::json& points) {
    std::vector<TransferKnot> knots;
    for (const auto& point : points) {
        const auto n = point.get<std::vector<double>>();
        knots.push_back({n[0], {glm::dvec3(n[1], n[2], n[3]), n[4]}});
    }
    return TransferFunction::linear(knots);
}

TransferFunction random_transfer_function(std::mt19937& random, const glm::dvec3* color = nullptr) {
    std::uniform_real_distribution<double> unit(0, 1);
    std::vector<TransferKnot> knots;
    double value = 0;
    for (int i = 0; i < 6; ++i) {
        const glm::dvec3 own(unit(random), unit(random), unit(random));
        const double extinction = unit(random) < 0.3 ? 0 : std::pow(10, 6 * unit(random) - 3);
        knots.push_back({value, {color ? *color : own, extinction}});
        if (unit(random) < 0.7) value += unit(random);
        if (i > 0 && value == knots[i - 1].value) value += 0.25;
    }
    return TransferFunction::linear(knots);
}

// Compares with make_integral_cases.py, which computes another formula with 50 digits.
TEST(SegmentIntegral, AgreesWithAComputationOf50Digits) {
    std::ifstream file(std::string(LAMINA_SOURCE_DIR) + "/tests/optics/integral_cases.json");
    const auto cases = nlohmann::json::parse(file);
    ASSERT_GT(cases.size(), 250u);
    for (const auto& c : cases) {
        const auto found =
            integrate_segment(transfer_function_of(c["points"]), c["sf"], c["sb"], c["length"]);
        EXPECT_LE(relative_error(found.alpha, c["alpha"]), promised) << c.dump();
        for (int i = 0; i < 3; ++i) {
            const double expected = c["color"][i];
            // The script writes 0 for what doubles cannot hold with full precision.
            if (expected == 0)
                EXPECT_LE(found.color[i], 2.3e-308) << c.dump();
            else
                EXPECT_LE(relative_error(found.color[i], expected), promised) << i << c.dump();
        }
    }
}

TEST(SegmentIntegral, IsAnExponentialInAHomogeneousSegment) {
    const glm::dvec3 color(0.2, 1, 3);
    const auto f = TransferFunction::linear({{0, {color, 2.5}}});
    for (const double length : {0., 1e-300, 1e-9, 1., 4., 100., 1e300}) {
        const auto found = integrate_segment(f, -1, 4, length);
        const double alpha = -std::expm1(-2.5 * length);
        EXPECT_LE(relative_error(found.alpha, alpha), 1e-15);
        // Both weights come from sums of up to 16 terms: some 1e-15.
        for (int i = 0; i < 3; ++i) {
            EXPECT_LE(relative_error(found.color[i], color[i] * alpha), 1e-14);
        }
    }
}

TEST(SegmentIntegral, IsColorTimesAlphaInBothDirectionsForOneColor) {
    std::mt19937 random(7);
    const glm::dvec3 color(0.25, 1, 0.75);
    std::uniform_real_distribution<double> scalar(-1, 5);
    for (int i = 0; i < 500; ++i) {
        const auto f = random_transfer_function(random, &color);
        const double a = scalar(random), b = scalar(random), length = std::pow(10, scalar(random));
        const auto there = integrate_segment(f, a, b, length);
        const auto back = integrate_segment(f, b, a, length);
        EXPECT_LE(relative_error(there.alpha, back.alpha), promised);
        for (int c = 0; c < 3; ++c) {
            EXPECT_LE(relative_error(there.color[c], color[c] * there.alpha), promised);
        }
    }
}

TEST(SegmentIntegral, HalvesComposeToTheWhole) {
    std::mt19937 random(8);
    std::uniform_int_distribution<int> eighth(-8, 40);
    for (int i = 0; i < 500; ++i) {
        const auto f = random_transfer_function(random);
        // Ends are multiples of 1/8, so the middle is exact. If it is on a step, its later side
        // counts only where the segment has no length, so this does not matter.
        const double a = eighth(random) / 8., b = eighth(random) / 8., length = 0.5;
        const auto whole = integrate_segment(f, a, b, 2 * length);
        const auto near = integrate_segment(f, a, (a + b) / 2, length);
        const auto far = integrate_segment(f, (a + b) / 2, b, length);
        EXPECT_LE(relative_error(near.optical_depth + far.optical_depth, whole.optical_depth),
                  promised);
        const glm::dvec3 color = near.color + std::exp(-near.optical_depth) * far.color;
        for (int c = 0; c < 3; ++c) EXPECT_LE(relative_error(color[c], whole.color[c]), promised);
    }
}

TEST(SegmentIntegral, IsFiniteForExtremeExtinctionsAndLengths) {
    for (const double tau : {0., 1e-300, 1e-200, 1., 1e200, 1e300}) {
        for (const double length : {0., 1e-300, 1., 1e300}) {
            for (const double other : {0., 1e-9, 1., 1.5}) {
                const auto f = TransferFunction::linear(
                    {{0, {glm::dvec3(1, 0, 0.5), tau}}, {1, {glm::dvec3(0, 1, 0.5), tau * other}}});
                const auto found = integrate_segment(f, 0, 1, length);
                EXPECT_TRUE(std::isfinite(found.optical_depth));
                EXPECT_GE(found.alpha, 0);
                EXPECT_LE(found.alpha, 1);
                for (int c = 0; c < 3; ++c) EXPECT_GE(found.color[c], 0);
                for (int c = 0; c < 3; ++c) EXPECT_LE(found.color[c], 1 + 1e-15);
            }
        }
    }
}

TEST(PieceWeights, AddUpToTheOpacityAcrossTheChangesOfMethod) {
    for (const double depth :
         {1e-12, 0.0399999, 0.04, 0.499999, 0.5, 3.99999, 4., 4.0001, 50., 1e6}) {
        for (const double share : {0., 1e-12, 1e-3, 0.5 - 1e-13, 0.5, 0.5 + 1e-9, 0.7, 1.}) {
            const double p = 2 * depth * share, q = 2 * depth * (1 - share);
            const PieceWeights weights = piece_weights(p, q);
            EXPECT_GE(weights.front, 0);
            EXPECT_GE(weights.back, 0);
            EXPECT_LE(relative_error(weights.front + weights.back, -std::expm1(-(p / 2 + q / 2))),
                      1e-14)
                << depth << " " << share;
            if (depth < 1e-10) {  // the limit D -> 0: the means of tau (1 - x) and tau x
                EXPECT_LE(relative_error(weights.front, p / 3 + q / 6), 1e-11);
                EXPECT_LE(relative_error(weights.back, p / 6 + q / 3), 1e-11);
            }
        }
    }
}

TEST(SegmentIntegral, AConstantScalarAtAStepTakesTheLaterSide) {
    const auto f = TransferFunction::linear({{0, {glm::dvec3(1), 1}}, {0, {glm::dvec3(0.5), 2}}});
    EXPECT_EQ(integrate_segment(f, 0, 0, 1).optical_depth, 2);
    EXPECT_EQ(integrate_segment(f, 0, 1, 1).optical_depth, 2);
    EXPECT_EQ(integrate_segment(f, 0, -1, 1).optical_depth, 1);
}

}  // namespace
}  // namespace lamina
