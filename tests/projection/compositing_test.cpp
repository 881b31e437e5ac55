// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "compositing/codes.h"

namespace lamina {
namespace {

// The mean over random numbers is OVER in real arithmetic. The bound is five standard deviations:
// for a mean of 65536 draws of 0 or 1 one is below .5 / 256 = .002 codes.
TEST(StochasticOver, IsUnbiased) {
    for (const double alpha : {.001, .3, .77}) {
        for (const std::uint32_t below : {0u, 7u, 200u, 255u}) {
            double sum = 0;
            for (std::uint32_t i = 0; i < 65536; ++i)
                sum += over_stochastic(.5 * alpha, alpha, below, random_bits(i, 0, 0, 1), 255);
            EXPECT_NEAR(sum / 65536, 255 * .5 * alpha + below * (1 - alpha), .01);
        }
    }
}

TEST(StochasticOver, StaysInRange) {
    EXPECT_EQ(over_stochastic(1, 1, 255, 0xffffffff, 255), 255u);
    EXPECT_EQ(over_stochastic(0, 0, 255, 0, 255), 255u);
    EXPECT_EQ(over_stochastic(0, 0, 0, 0, 255), 0u);
    EXPECT_EQ(over_stochastic(1, .5, 255, 0, 255), 255u);  // source above alpha: clamped
}

}  // namespace
}  // namespace lamina
