// SPDX-License-Identifier: Apache-2.0
#include "study/time_left.h"

#include <gtest/gtest.h>

#include <initializer_list>
#include <vector>

namespace lamina::study {
namespace {

using Steps = std::vector<LadderCost::Step>;

Steps steps_of(std::initializer_list<double> tolerances, std::int64_t most, bool last_if_full) {
    Steps steps;
    for (const double each : tolerances) steps.push_back({each, most, last_if_full});
    return steps;
}

// Returns a cost after two meshes: the number of tets grows with the power 3 of 1 / tolerance, and
// each tet takes a millisecond.
LadderCost after_two_meshes() {
    LadderCost cost;
    cost.add(.1, 1000, 1);
    cost.add(.05, 8000, 8);
    return cost;
}

TEST(LadderCost, FollowsTheMeasuredPower) {
    const LadderCost cost = after_two_meshes();
    EXPECT_NEAR(cost.expected_seconds(steps_of({.025, .0125}, 1000000, true)), 64 + 512, 1e-9);
}

// The third mesh has 64,000 tets; the fourth would have 512,000, and gets the most, 100,000.
TEST(LadderCost, EndsWithTheMeshOfTheMostTets) {
    const LadderCost cost = after_two_meshes();
    EXPECT_NEAR(cost.expected_seconds(steps_of({.025, .0125, .00625}, 100000, true)), 64 + 100,
                1e-9);
    EXPECT_NEAR(cost.expected_seconds(steps_of({.025, .0125, .00625}, 100000, false)),
                64 + 100 + 100, 1e-9);
    // The scene's own mesh is made in any case.
    Steps with_own = steps_of({.0125, .00625}, 100000, true);
    with_own.push_back({.003125, 200000, false});
    EXPECT_NEAR(cost.expected_seconds(with_own), 100 + 200, 1e-9);
}

TEST(LadderCost, BoundsWhatIsNotKnown) {
    const auto seconds = [](const Steps& steps) { return LadderCost::most_seconds(steps); };
    const double one = seconds(steps_of({.1}, 100000, false));
    EXPECT_GT(one, 0);
    EXPECT_NEAR(seconds(steps_of({.1, .05, .02}, 100000, false)), 3 * one, 1e-9);
    // However long a ladder is, its last mesh is assumed to have more than half of all tets.
    const double ladder = seconds(steps_of({.1, .05, .02, .01, .005}, 100000, true));
    EXPECT_LT(ladder, 2 * one);
    EXPECT_GT(ladder, one);
    Steps with_own = steps_of({.1, .05, .02, .01, .005}, 100000, true);
    with_own.push_back({.001, 300000, false});
    EXPECT_NEAR(seconds(with_own), ladder + 3 * one, 1e-9);
}

}  // namespace
}  // namespace lamina::study
