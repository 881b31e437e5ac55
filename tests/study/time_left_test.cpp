// SPDX-License-Identifier: Apache-2.0
#include "study/time_left.h"

#include <gtest/gtest.h>

namespace lamina::study {
namespace {

TEST(TimeLeft, FollowsTheMeasuredTimes) {
    TimeLeft left;
    left.add_first(10, 2);
    left.add_first(20, 4);
    // A first visit takes 15 s, of which 3 s are what a later visit does.
    EXPECT_DOUBLE_EQ(left.of(4, 0), 60);
    EXPECT_DOUBLE_EQ(left.of(4, 10), 90);
    left.add_later(5);
    left.add_later(7);
    EXPECT_DOUBLE_EQ(left.of(4, 10), 120);
    EXPECT_DOUBLE_EQ(left.of(0, 0), 0);
}

TEST(TimeLeft, IsGivenInFewDigits) {
    EXPECT_EQ(duration_text(0.2), "less than 1 s");
    EXPECT_EQ(duration_text(0.5), "1 s");
    EXPECT_EQ(duration_text(99.4), "99 s");
    EXPECT_EQ(duration_text(99.6), "2 min");
    EXPECT_EQ(duration_text(3600), "60 min");
    EXPECT_EQ(duration_text(2 * 3600 + 11 * 60), "2 h 11 min");
    EXPECT_EQ(duration_text(5 * 86400.0), "5 days");
}

}  // namespace
}  // namespace lamina::study
