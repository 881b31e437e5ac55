// SPDX-License-Identifier: Apache-2.0
#include "work/draw_worker.h"

#include <gtest/gtest.h>

namespace lamina::view {
namespace {

// Pictures that take `fixed` and, in full, `all` ms more.
double divisor_after(double fixed, double all, int pictures) {
    CoarseSize size(35);
    size.add(1, fixed + all);
    for (int i = 0; i < pictures; ++i) {
        const double divisor = size.divisor();
        size.add(divisor, fixed + all / (divisor * divisor));
    }
    return size.divisor();
}

TEST(CoarseSize, FindsTheLargestPictureThatIsInTime) {
    EXPECT_EQ(divisor_after(0, 30, 10), 1);    // all of it, in 30 ms
    EXPECT_EQ(divisor_after(0, 100, 10), 2);   // 25 ms; 44 by 1.5
    EXPECT_EQ(divisor_after(0, 1000, 10), 6);  // 28 ms; 62 by 4
    EXPECT_EQ(divisor_after(20, 200, 10), 4);  // 20 + 12.5 ms; 20 + 22 by 3
}

// Nothing can be done about a fixed part of 100 ms: 125 by 4, 101.6 by 16; 144 by 3 is too much.
TEST(CoarseSize, DoesNotGiveUpPixelsForNothing) {
    EXPECT_EQ(divisor_after(100, 400, 10), 4);
}

TEST(CoarseSize, FollowsWhatPicturesTake) {
    CoarseSize size(35);
    size.add(1, 30);
    EXPECT_EQ(size.divisor(), 1);
    size.add(1, 300);
    EXPECT_EQ(size.divisor(), 12);  // 25, if no more than the edges tell
    size.add(12, 5);
    EXPECT_EQ(size.divisor(), 4);  // 21.5; 36 by 3
    size.add(4, 20);
    size.add(4, 40);               // another view: twice as slow
    EXPECT_EQ(size.divisor(), 6);  // between 10 by 12 and 40 by 4: 21
    size.add(6, 20);
    size.add(6, 10);               // and half of that again
    EXPECT_EQ(size.divisor(), 3);  // between 20 by 4 and 300 by 1: 34.5
}

TEST(CoarseSize, IsSmallBeforeAnythingIsKnown) {
    EXPECT_EQ(CoarseSize(35).divisor(), 4);
}

}  // namespace
}  // namespace lamina::view
