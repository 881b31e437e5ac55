// SPDX-License-Identifier: Apache-2.0
#include "choice/value_distribution.h"

#include <gtest/gtest.h>

#include <limits>
#include <numeric>

namespace lamina {
namespace {

TEST(BinnedValues, EachIntervalHasEquallyManyWholeNumbers) {
    // The numbers 0 to 11 in at most five intervals: four intervals of three numbers.
    const ValueDistribution values({{0, 1}, {2, 1}, {3, 4}, {11, 2}});
    const ValueHistogram histogram = binned(values, {0, 11}, true, 5);
    EXPECT_EQ(histogram.lo, -.5);
    EXPECT_EQ(histogram.hi, 11.5);
    EXPECT_EQ(histogram.least, 0);
    EXPECT_EQ(histogram.most, 11);
    EXPECT_EQ(histogram.shares, (std::vector<double>{2. / 8, 4. / 8, 0, 2. / 8}));
}

TEST(BinnedValues, AnEdgeBelongsToTheUpperIntervalButForTheLast) {
    const ValueDistribution values({{0, 1}, {.5, 2}, {1, 5}});
    const ValueHistogram histogram = binned(values, {0, 1}, false, 2);
    EXPECT_EQ(histogram.lo, 0);
    EXPECT_EQ(histogram.hi, 1);
    EXPECT_EQ(histogram.shares, (std::vector<double>{1. / 8, 7. / 8}));
}

TEST(BinnedValues, HaveOneIntervalForOneValueAndNoneForNone) {
    EXPECT_EQ(binned(ValueDistribution({{7, 3}}), {7, 7}, false, 100).shares,
              std::vector<double>{1});
    EXPECT_TRUE(binned({}, {}, false, 100).shares.empty());
}

TEST(BinnedValues, TheWidestRangeDoesNotOverflow) {
    constexpr double most = std::numeric_limits<double>::max();
    const ValueHistogram histogram =
        binned(ValueDistribution({{-most, 1}, {0, 1}, {most, 2}}), {-most, most}, false, 4);
    EXPECT_EQ(histogram.shares, (std::vector<double>{1. / 4, 0, 1. / 4, 2. / 4}));
}

}  // namespace
}  // namespace lamina
