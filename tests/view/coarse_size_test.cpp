// SPDX-License-Identifier: Apache-2.0
#include "work/draw_worker.h"

#include <gtest/gtest.h>

namespace lamina::view {
namespace {

// Returns the divisor of the picture's sides that CoarseSize chooses after `pictures` pictures, if
// a picture takes `fixed` ms, and `all` ms more for its pixels, which shrink with the divisor
// squared.
double divisor_after(double fixed, double all, int pictures) {
    CoarseSize size(35);
    size.add(1, fixed + all);
    for (int i = 0; i < pictures; ++i) {
        const double divisor = size.divisor();
        size.add(divisor, fixed + all / (divisor * divisor));
    }
    return size.divisor();
}

TEST(CoarseSize, FindsTheLargestPictureWithinTheTime) {
    EXPECT_EQ(divisor_after(0, 30, 10), 1);    // at full size a picture takes 30 ms, of 35 allowed
    EXPECT_EQ(divisor_after(0, 100, 10), 2);   // 25 ms; with divisor 1.5 it would take 44
    EXPECT_EQ(divisor_after(0, 1000, 10), 6);  // 28 ms; with divisor 4 it would take 62
    EXPECT_EQ(divisor_after(20, 200, 10), 4);  // 20 + 12.5 ms; with divisor 3: 20 + 22
}

// A fixed part of 100 ms exceeds the 35 ms by itself. Divisor 16 takes 101.6 ms, hardly less than
// the 125 ms of divisor 4, which is therefore kept; divisor 3 takes 144 ms.
TEST(CoarseSize, DoesNotGiveUpPixelsForNothing) {
    EXPECT_EQ(divisor_after(100, 400, 10), 4);
}

TEST(CoarseSize, FollowsTheTimesOfPictures) {
    CoarseSize size(35);
    size.add(1, 30);
    EXPECT_EQ(size.divisor(), 1);
    size.add(1, 300);
    EXPECT_EQ(size.divisor(), 12);  // 25 ms, if times only depend on the number of pixels
    size.add(12, 5);
    EXPECT_EQ(size.divisor(), 4);  // 21.5 ms expected; 36 with divisor 3
    size.add(4, 20);
    size.add(4, 40);               // another view takes twice as long
    EXPECT_EQ(size.divisor(), 6);  // 21 ms, between 10 ms (divisor 12) and 40 ms (divisor 4)
    size.add(6, 20);
    size.add(6, 10);               // a view that takes half as long
    EXPECT_EQ(size.divisor(), 3);  // 34.5 ms, between 20 ms (divisor 4) and 300 ms (divisor 1)
}

TEST(CoarseSize, IsSmallBeforeAnythingIsKnown) {
    EXPECT_EQ(CoarseSize(35).divisor(), 4);
}

}  // namespace
}  // namespace lamina::view
