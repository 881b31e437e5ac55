// SPDX-License-Identifier: Apache-2.0
#include "optics/front_parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "optics/preintegration_table.h"
#include "support/transfer_functions.h"

namespace lamina {
namespace {

using test::knot;
using test::smooth;

TransferFunction peak_and_step() {
    return TransferFunction::linear(
        {knot(0, glm::dvec3(1, 0, 0), 0), knot(.3, glm::dvec3(1, .5, 0), 0),
         knot(.303, glm::dvec3(1, .8, .2), 60), knot(.306, glm::dvec3(0, .5, 1), 0),
         knot(.6, glm::dvec3(1, 0, 1), 1), knot(.6, glm::dvec3(0, 0, 1), 5),
         knot(1, glm::dvec3(0, 1, 0), 8)});
}

// Simpson's rule over the root of the optical depth, in which the place is smooth.
double moment_by_depth(double p, double q) {
    const double depth = p / 2 + q / 2, end = std::sqrt(std::min(depth, 40.));
    const auto integrand = [&](double s) {
        const double t = s * s;
        const double root = std::sqrt(std::max(p * p + 2 * (q - p) * t, 0.));
        const double x = t == 0 ? 0 : std::min(2 * t / (p + root), 1.);
        return (1 - x) * (1 - x) * std::exp(-t) * 2 * s;
    };
    constexpr int panels = 20000;
    const double step = end / panels;
    double sum = 0;
    for (int i = 0; i < panels; ++i)
        sum += step / 6 *
               (integrand(i * step) + 4 * integrand((i + .5) * step) + integrand((i + 1) * step));
    return sum;
}

TEST(FrontParts, MomentAgreesWithAnIntegralOverDepth) {
    for (const double p : {0., 1e-6, .01, .3, 1., 4., 19., 45., 300., 1e7}) {
        for (const double q : {0., 1e-5, .02, .7, 2., 7., 30., 1e3, 1e8}) {
            if (p + q == 0) continue;
            EXPECT_NEAR(front_moment(p, q), moment_by_depth(p, q), 1e-8) << p << " " << q;
        }
    }
    EXPECT_EQ(front_moment(0, 0), 0);
}

// Of two places one in front of the other, with one extinction: int (1 - x) D exp(-D x) dx.
TEST(FrontParts, HomogeneousSegmentHasAClosedForm) {
    const glm::dvec3 color(.2, 1, 3);
    const auto f = TransferFunction::linear({{0, {color, 2.5}}});
    for (const double length : {1e-6, .1, 1., 4., 100.}) {
        const double depth = 2.5 * length;
        const double expected =
            depth < 1e-3 ? depth / 2 - depth * depth / 6 : 1 + std::expm1(-depth) / depth;
        const LitIntegral found = integrate_lit_segment(f, .3, .3, length);
        EXPECT_NEAR(found.front.alpha, expected, 1e-8);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(found.front.color[c], color[c] * expected, color[c] * 1e-8);
    }
}

// Many short segments one behind the other, each under the light of its middle: off by a 24th of
// the square of their share of the length times the light's second difference, which is 0, and by
// the product of what light and colour change in one, 1 / 4000 each.
TEST(FrontParts, AgreesWithManyShortSegments) {
    constexpr int count = 4000;
    for (const auto& f : {smooth(), peak_and_step()}) {
        for (const auto& [front, back] : {std::pair(.1, .9), {.95, .2}, {.32, .29}, {.5, .5}}) {
            constexpr double length = .8;
            FrontParts sum;
            double depth = 0;
            for (int i = 0; i < count; ++i) {
                const auto at = [&](int j) { return front + (back - front) * j / count; };
                const auto part = integrate_segment(f, at(i), at(i + 1), length / count);
                const double light = 1 - (i + .5) / count, seen = std::exp(-depth);
                sum.alpha += light * seen * part.alpha;
                sum.color += light * seen * part.color;
                depth += part.optical_depth;
            }
            const LitIntegral found = integrate_lit_segment(f, front, back, length);
            EXPECT_NEAR(found.front.alpha, sum.alpha, 1. / count / count * 4);
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(found.front.color[c], sum.color[c], 1. / count / count * 4);
        }
    }
}

double largest_error(const FrontParts& a, const FrontParts& b) {
    double worst = std::abs(a.alpha - b.alpha);
    for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(a.color[c] - b.color[c]));
    return worst;
}

PreintegrationTable table_of(const TransferFunction& f, int nodes, int layers) {
    PreintegrationRequest request{0, 1, .5, nodes, layers};
    request.lit = true;
    return build_preintegration_table(f, request);
}

// On lengths of its own, where nothing is interpolated.
TEST(FrontParts, TableIsExactFromPointToPoint) {
    const auto f = peak_and_step();
    const PreintegrationTable table = table_of(f, 24, 4);
    for (const auto& [one, other] : {std::pair(0., .3), {.3, .303}, {.303, .306}}) {
        for (const double length : {.5 / 3, 1. / 3, .5}) {
            for (const auto& [front, back] : {std::pair(one, other), {other, one}, {one, one}}) {
                const LitIntegral found = table.lookup_lit(front, back, length);
                const LitIntegral expected = integrate_lit_segment(f, front, back, length);
                // Floats, 6e-8 each, in some ten operations, and the moments' 1e-8.
                EXPECT_LE(largest_error(found.front, expected.front), 7e-7) << front << " " << back;
                EXPECT_NEAR(found.whole.alpha, expected.whole.alpha, 2e-7);
            }
        }
    }
}

double worst_error(const TransferFunction& f, int nodes, int layers) {
    const PreintegrationTable table = table_of(f, nodes, layers);
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

// Interpolation is linear in scalars and lengths: with four times the nodes the error falls 16
// times, to half of that where the worst segments are others. The first table is good to a node's
// share of the range squared, some 1 / 32^2, times the colours' and extinctions' changes.
TEST(FrontParts, TableConverges) {
    for (const auto& f : {smooth(), peak_and_step()}) {
        const double coarse = worst_error(f, 32, 5), fine = worst_error(f, 128, 17);
        EXPECT_LE(fine, coarse / 8);
        EXPECT_LE(fine, 1. / 255 / 4);
    }
}

TEST(FrontParts, UnlitTablesHaveNone) {
    const auto table = build_preintegration_table(smooth(), {0, 1, .5, 32, 3, true});
    EXPECT_FALSE(table.lit());
    PreintegrationRequest request{0, 1, .5, 32, 3, true};
    request.lit = true;
    const auto lit = build_preintegration_table(smooth(), request);
    EXPECT_TRUE(lit.lit());
    EXPECT_EQ(lit.emission, table.emission);
    EXPECT_EQ(lit.mean_extinction, table.mean_extinction);
}

}  // namespace
}  // namespace lamina
