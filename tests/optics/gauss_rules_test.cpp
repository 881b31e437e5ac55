// SPDX-License-Identifier: Apache-2.0
#include "optics/segment_integral.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lamina {
namespace {

// A rule of n points integrates polynomials up to degree 2n - 1 exactly. Sums of n positive terms
// have errors of n half ulps, and powers as many.
TEST(GaussRules, IntegratePolynomialsExactly) {
    for (const GaussRule& rule : {gauss4, gauss5, gauss6, gauss8, gauss16}) {
        for (int degree = 0; degree < static_cast<int>(2 * rule.points); ++degree) {
            double sum = 0;
            for (std::size_t i = 0; i < rule.points; ++i)
                sum += rule.weight[i] * std::pow(rule.x[i], degree);
            const double expected = 1.0 / (degree + 1);
            EXPECT_NEAR(sum, expected, 4e-15 * expected) << rule.points;
        }
    }
}

}  // namespace
}  // namespace lamina
