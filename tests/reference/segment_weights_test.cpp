// SPDX-License-Identifier: Apache-2.0
#include "reference/segment_weights.h"

#include <gtest/gtest.h>

#include <cmath>

#include "fixtures.h"

namespace lamina {
namespace {

TEST(SegmentWeights, AreThoseOfThePiece) {
    reference_test::Random random(6);
    for (int i = 0; i < 20000; ++i) {
        const double p = i % 7 == 0 ? 0 : std::pow(10, random.uniform(-300, 3));
        const double q = i % 5 == 0   ? 0
                         : i % 2 == 0 ? p * random.uniform(0, 2)
                                      : std::pow(10, random.uniform(-12, 3));
        const PieceWeights expected = piece_weights(p, q), found = segment_weights(p, q);
        // Expm1() of Highway is good to 4 units in the last place, and all terms are >= 0.
        EXPECT_NEAR(found.front, expected.front, 3e-15 * expected.front);
        EXPECT_NEAR(found.back, expected.back, 3e-15 * expected.back);
    }
}

}  // namespace
}  // namespace lamina
