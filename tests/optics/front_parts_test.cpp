// SPDX-License-Identifier: Apache-2.0
#include "optics/segment_integral.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/transfer_functions.h"

namespace lamina {
namespace {

using test::peak_and_step;
using test::smooth;

// Integrates by Simpson's rule over the root of the optical depth, of which the place is a smooth
// function.
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

// With one extinction the integral is int (1 - x) D exp(-D x) dx.
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

// Composites many short segments, each under the light of its middle. The error is a 24th of the
// square of their share of the length times the light's second difference, which is 0, plus the
// product of the changes of light and of colour in one segment, 1 / 4000 each.
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

}  // namespace
}  // namespace lamina
