// SPDX-License-Identifier: Apache-2.0
#include "choice/value_distribution.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace lamina {
namespace {

TEST(ValueDistribution, HasTheSharesAndQuantilesOfItsValues) {
    const ValueDistribution values({{3, 2}, {1, 1}, {3, 2}, {7, 0}, {5, 3}});
    ASSERT_EQ(values.distinct(), 3u);  // 7 has no weight
    EXPECT_EQ(values.lowest(), 1);
    EXPECT_EQ(values.highest(), 5);
    EXPECT_EQ(values.share_up_to(.5), 0);
    EXPECT_EQ(values.share_up_to(1), 1. / 8);
    EXPECT_EQ(values.share_up_to(4), 5. / 8);
    EXPECT_EQ(values.share_below(3), 1. / 8);
    EXPECT_EQ(values.share_below(9), 1);
    EXPECT_EQ(values.share(3, 3), 4. / 8);
    EXPECT_EQ(values.quantile(0), 1);
    EXPECT_EQ(values.quantile(1. / 8), 1);
    EXPECT_EQ(values.quantile(.126), 3);
    EXPECT_EQ(values.quantile(1), 5);
}

TEST(ValueDistribution, RescalesTheSharesOfAnIntervalToOne) {
    const ValueDistribution part =
        ValueDistribution({{1, 1}, {2, 1}, {3, 3}, {4, 5}}).between(2, 3.5);
    ASSERT_EQ(part.distinct(), 2u);
    EXPECT_EQ(part.share_up_to(2), 1. / 4);
    EXPECT_EQ(part.share_up_to(3), 1);
    EXPECT_TRUE(part.between(2.1, 2.9).empty());
}

// Rounding of sums depends on their order, so the constructor must add weights in an order of its
// own.
TEST(ValueDistribution, DoesNotDependOnTheOrderThatValuesComeIn) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> weight(0, 1);
    std::vector<WeightedValue> values;
    for (int i = 0; i < 5000; ++i)
        values.push_back({static_cast<double>(random() % 50), weight(random)});
    const ValueDistribution first(values);
    std::ranges::shuffle(values, random);
    const ValueDistribution second(values);
    for (int i = 0; i < 50; ++i) EXPECT_EQ(first.share_up_to(i), second.share_up_to(i)) << i;
}

}  // namespace
}  // namespace lamina
