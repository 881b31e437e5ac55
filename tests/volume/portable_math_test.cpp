// SPDX-License-Identifier: Apache-2.0
#include "volume/generate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace lamina {
namespace {

TEST(PortableMath, ExpAgreesWithLibm) {
    for (double x = -700; x <= 700; x += 0.37) {
        // Each of Horner's 14 steps rounds by half an ulp at most, mostly by far less.
        EXPECT_NEAR(portable_exp(x) / std::exp(x), 1, 1e-15) << x;
    }
    EXPECT_EQ(portable_exp(0), 1);
}

TEST(PortableMath, CosineAgreesWithLibm) {
    for (double turns = -3; turns <= 3; turns += 0.0037) {
        // The argument 2 pi t of std::cos itself is off by 6 pi * 1.1e-16 * 2 = 4e-15 at |t| = 3.
        EXPECT_NEAR(portable_cos_turns(turns), std::cos(2 * std::numbers::pi * turns), 5e-15)
            << turns;
    }
    EXPECT_EQ(portable_cos_turns(0), 1);
    EXPECT_EQ(portable_cos_turns(0.5), -1);
    EXPECT_NEAR(portable_cos_turns(0.25), 0, 1e-16);
}

}  // namespace
}  // namespace lamina
