// SPDX-License-Identifier: Apache-2.0
#include "work/coarse_size.h"

#include <gtest/gtest.h>

namespace lamina::view {
namespace {

// Pictures of 1000 x 1000 pixels that take fixed + each * pixels.
double divisor_after(double fixed, double each, int pictures) {
    CoarseSize size(35);
    size.add(1e6, fixed + each * 1e6);
    double divisor = 0;
    for (int i = 0; i < pictures; ++i) {
        divisor = size.divisor(1000, 1000);
        const double pixels = 1e6 / (divisor * divisor);
        size.add(pixels, fixed + each * pixels);
    }
    return divisor;
}

TEST(CoarseSize, FindsTheLargestPictureThatIsInTime) {
    EXPECT_EQ(divisor_after(0, 30e-6, 10), 1);    // all of it, in 30 ms
    EXPECT_EQ(divisor_after(0, 100e-6, 10), 2);   // 25 ms; 44 by 1.5
    EXPECT_EQ(divisor_after(0, 1000e-6, 10), 6);  // 28 ms; 62 by 4
    EXPECT_EQ(divisor_after(20, 200e-6, 10), 4);  // 20 + 12.5 ms; 20 + 22 by 3
}

// Nothing can be done about a fixed part of 100 ms; the pixels may take 50.
TEST(CoarseSize, DoesNotGiveUpPixelsForNothing) {
    EXPECT_EQ(divisor_after(100, 400e-6, 10), 3);  // 44 ms; 100 by 2
}

TEST(CoarseSize, FollowsWhatPicturesTake) {
    CoarseSize size(35);
    for (int i = 0; i < 30; ++i) size.add(1e6, 30);
    EXPECT_EQ(size.divisor(1000, 1000), 1);
    for (int i = 0; i < 30; ++i) size.add(1e6, 300);
    EXPECT_EQ(size.divisor(1000, 1000), 3);
}

TEST(CoarseSize, IsSmallBeforeAnythingIsKnown) {
    EXPECT_EQ(CoarseSize(35).divisor(1000, 1000), 4);
}

}  // namespace
}  // namespace lamina::view
