// SPDX-License-Identifier: Apache-2.0
#include "reference/mesh_walk.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "fixtures.h"
#include "reference/transfer_intervals.h"
#include "support/each_instruction_set.h"

namespace lamina {
namespace {

using reference_test::Random;

// Returns a function with two ranges of values that show something.
TransferFunction two_peaks() {
    const auto knot = [](double value, double extinction) {
        return TransferKnot{value, {glm::dvec3(1), extinction}};
    };
    return TransferFunction::linear(
        {knot(1, 0), knot(2, 1), knot(3, 0), knot(5, 0), knot(6, 1), knot(7, 0)});
}

// Expects the numbers of seen_segment(), bit by bit.
void test_segments() {
    Random random(9);
    const TransferFunction function = two_peaks();
    const TransferIntervals intervals(function);
    std::size_t shown = 0, hidden = 0, cut = 0;
    for (int i = 0; i < 1000; ++i) {
        WalkLanes walk{};
        SeenLanes seen{};
        for (std::size_t lane = 0; lane < WalkLanes::width; ++lane) {
            const double from = random.uniform(0, 4);
            walk.in().at[lane] = from;
            walk.out().at[lane] = random.below(8) == 0 ? from : from + random.uniform(.1, 1);
            walk.in().value[lane] = random.uniform(0, 8);
            walk.out().value[lane] = random.uniform(0, 8);
            const bool constant = random.below(4) == 0;
            if (constant) walk.out().value[lane] = walk.in().value[lane];
            walk.least[lane] = constant ? walk.in().value[lane] : 0;
            walk.most[lane] = constant ? walk.in().value[lane] : 8;
            seen.first[lane] = random.uniform(0, 2);
            seen.last[lane] = random.below(3) == 0 ? INFINITY : random.uniform(1, 5);
            seen.world_per_z[lane] = 2;
        }
        find_seen(walk, intervals.columns(), seen);
        for (std::size_t lane = 0; lane < WalkLanes::width; ++lane) {
            const SeenSegment whole{walk.in().at[lane], walk.out().at[lane], walk.in().value[lane],
                                    walk.out().value[lane]};
            const SeenSegment part = seen_segment(whole, {seen.first[lane], seen.last[lane]});
            const double slack = scalar_slack(walk.least[lane], walk.most[lane]);
            const auto [lo, hi] = std::minmax(part.front, part.back);
            const bool shows = part.from < part.to && intervals.visible(lo - slack, hi + slack);
            ASSERT_EQ((seen.shown >> lane & 1) != 0, shows);
            ++(shows ? shown : hidden);
            if (!shows) continue;
            cut += part.from != whole.from || part.to != whole.to;
            EXPECT_EQ(seen.from[lane], part.from);
            EXPECT_EQ(seen.to[lane], part.to);
            EXPECT_EQ(seen.front[lane], part.front);
            EXPECT_EQ(seen.back[lane], part.back);
            EXPECT_EQ(seen.length[lane], 2 * (part.to - part.from));
            EXPECT_EQ(seen.slack[lane], slack);
        }
    }
    EXPECT_GT(shown, 500u);
    EXPECT_GT(hidden, 500u);
    EXPECT_GT(cut, 100u);
}

TEST(SeenLanes, AreTheVisibleSegments) {
    test::for_each_instruction_set([](const std::string&) { test_segments(); });
}

}  // namespace
}  // namespace lamina
