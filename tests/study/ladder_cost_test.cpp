// SPDX-License-Identifier: Apache-2.0
#include "study/ladder_cost.h"

#include <gtest/gtest.h>

#include <array>

namespace lamina::study {
namespace {

TEST(LadderCost, FollowsThePowerThatWasSeen) {
    LadderCost cost(1000000, true);
    cost.add(.1, 1000, 1);
    cost.add(.05, 8000, 8);  // the power 3, a millisecond a tet
    EXPECT_NEAR(cost.of(std::array{.025, .0125}), 64 + 512, 1e-9);
}

// The third mesh would have 512,000 tets, and stops at 100,000.
TEST(LadderCost, EndsWithTheMeshThatHasTheMost) {
    LadderCost cost(100000, true);
    cost.add(.1, 1000, 1);
    cost.add(.05, 8000, 8);
    EXPECT_NEAR(cost.of(std::array{.025, .0125, .00625}), 64 + 100, 1e-9);
    cost.add(.025, 100000, 90);
    EXPECT_EQ(cost.of(std::array{.0125}), 0);
    LadderCost all(100000, false);
    all.add(.1, 100000, 100);
    EXPECT_NEAR(all.of(std::array{.05, .025}), 200, 1e-9);
}

TEST(LadderCost, BoundsWhatIsNotKnown) {
    const LadderCost one(100000, false), ends(100000, true);
    EXPECT_NEAR(one.at_most(3), 3 * one.at_most(1), 1e-9);
    // However fine the ladder, its last mesh has half of all tets and more.
    EXPECT_LT(ends.at_most(7), 2 * ends.at_most(1));
    EXPECT_GT(ends.at_most(7), ends.at_most(1));
}

}  // namespace
}  // namespace lamina::study
