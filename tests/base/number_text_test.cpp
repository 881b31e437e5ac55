// SPDX-License-Identifier: Apache-2.0
#include "base/error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace lamina {
namespace {

TEST(NumberText, HasTheDigitsThatAreNeeded) {
    EXPECT_EQ(number_text(1234567, fineness_of(0, 1e7)), "1.235e+06");
    EXPECT_EQ(number_text(1234567, 0.5), "1234567");
    EXPECT_EQ(number_text(1000000, fineness_of(1e6, 1e6 + 4)), "1000000");
    EXPECT_EQ(number_text(1000000.25, fineness_of(1e6, 1e6 + 4)), "1000000.25");
    EXPECT_EQ(number_text(-3024, fineness_of(-3024, 3071)), "-3024");
    EXPECT_EQ(number_text(.5, 1e-300), "0.5");
    EXPECT_EQ(number_text(3.14159265, 1, 6), "3.14159");
}

TEST(NumberText, IsDefinedForNaNInfinityAndAnEmptyRange) {
    EXPECT_EQ(fineness_of(3, 3), INFINITY);
    EXPECT_EQ(number_text(1. / 3, fineness_of(1. / 3, 1. / 3)), "0.3333");
    EXPECT_EQ(number_text(NAN, 0), "nan");
    EXPECT_EQ(number_text(-INFINITY, 1), "-inf");
    constexpr double most = std::numeric_limits<double>::max();
    EXPECT_TRUE(std::isfinite(fineness_of(-most, most)));
    EXPECT_EQ(number_text(1. / 3, 0), "0.3333333333333333");
}

}  // namespace
}  // namespace lamina
