// SPDX-License-Identifier: Apache-2.0
#include "choice/value_distribution.h"

#include <gtest/gtest.h>

namespace lamina {
namespace {

// Appends the whole numbers from `first` to `last`, each with this weight.
void add(std::vector<WeightedValue>& values, int first, int last, double weight) {
    for (int value = first; value <= last; ++value)
        values.push_back({static_cast<double>(value), weight});
}

TEST(CommonValues, AirAroundWhatWasScannedIsBackground) {
    std::vector<WeightedValue> values;
    add(values, 0, 5, 100);    // 600 of 1455
    add(values, 90, 180, 5);   // tissue, 455
    add(values, 181, 255, 4);  // rarer, 300
    add(values, 6, 89, 1);     // blur between them, 84: 1 percent of the peak's density
    const CommonValues common = find_common_values(ValueDistribution(values), true);
    EXPECT_TRUE(common.background);
    EXPECT_EQ(common.lo, 0);
    EXPECT_EQ(common.hi, 5.5);
}

TEST(CommonValues, AFlowHasItsBackgroundInTheMiddle) {
    std::vector<WeightedValue> values;
    add(values, 0, 255, 1);
    add(values, 100, 103, 200);
    const CommonValues common = find_common_values(ValueDistribution(values), true);
    EXPECT_TRUE(common.background);
    EXPECT_EQ(common.lo, 99.5);
    EXPECT_EQ(common.hi, 103.5);
}

TEST(CommonValues, AreTheDensestThirdIfThereIsNoBackground) {
    std::vector<WeightedValue> values;
    add(values, 0, 199, 1);
    add(values, 200, 255, 2);  // 112 of 312: more than a third
    const CommonValues common = find_common_values(ValueDistribution(values), true);
    EXPECT_FALSE(common.background);
    EXPECT_GE(common.lo, 199);  // the third with 52 or 53 values lies in the denser part
    EXPECT_GE(ValueDistribution(values).share(common.lo, common.hi),
              1. / 3 - 1e-12);  // tolerance for rounding of sums up to 1
}

TEST(UsualRange, LeavesOutExtremeValuesUpToAThousandth) {
    std::vector<WeightedValue> values;
    add(values, -40, 40, 1000);
    values.push_back({-5000, 20});
    values.push_back({1800, 20});  // 81040 in all: 20 is a quarter of a thousandth
    const ValueRange range = usual_range(ValueDistribution(values));
    EXPECT_EQ(range.lo, -40);
    EXPECT_EQ(range.hi, 40);
    values.push_back({-5000, 2000});  // now more than a thousandth
    EXPECT_EQ(usual_range(ValueDistribution(values)).lo, -5000);
}

}  // namespace
}  // namespace lamina
