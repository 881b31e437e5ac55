// SPDX-License-Identifier: Apache-2.0
#include "image/difference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/expect_error.h"

namespace lamina {
namespace {

TEST(Metrics, RampHasTheClosedFormsOfItsSums) {
    // e = 0, 1, .. n-1 in channel R, constant -2 in G, 0 in B, +-3 alternating in A.
    constexpr int n = 1000;
    Difference difference{n / 10, 10, {"R", "G", "B", "A"}, {}};
    for (int i = 0; i < n; ++i) {
        for (const double e : {double(i), -2.0, 0.0, i % 2 == 0 ? 3.0 : -3.0}) {
            difference.e.push_back(e);
        }
    }
    const ImageError error = measure(difference);
    // All sums are integers below 2^53, so they are exact; only one division and one root round.
    EXPECT_EQ(error.channels, difference.channels);
    EXPECT_DOUBLE_EQ(error.of_channel[0].linf, n - 1);
    EXPECT_DOUBLE_EQ(error.of_channel[0].mean, (n - 1) / 2.0);
    EXPECT_DOUBLE_EQ(error.of_channel[0].l2, std::sqrt((n - 1) * (2.0 * n - 1) / 6));
    EXPECT_DOUBLE_EQ(error.of_channel[1].linf, 2);
    EXPECT_DOUBLE_EQ(error.of_channel[1].mean, -2);
    EXPECT_DOUBLE_EQ(error.of_channel[1].l2, 2);
    EXPECT_DOUBLE_EQ(error.of_channel[2].linf, 0);
    EXPECT_DOUBLE_EQ(error.of_channel[3].linf, 3);
    EXPECT_DOUBLE_EQ(error.of_channel[3].mean, 0);
    EXPECT_DOUBLE_EQ(error.of_channel[3].l2, 3);
    EXPECT_DOUBLE_EQ(error.all.linf, n - 1);
    EXPECT_DOUBLE_EQ(error.all.mean, ((n - 1) / 2.0 - 2) / 4);
    EXPECT_DOUBLE_EQ(error.all.l2, std::sqrt(((n - 1) * (2.0 * n - 1) / 6 + 4 + 9) / 4));
    EXPECT_EQ(error.worst.column, n / 10 - 1);
    EXPECT_EQ(error.worst.row, 9);
    EXPECT_EQ(error.worst.channel, 0u);
    EXPECT_EQ(error.worst.e, n - 1);
}

TEST(Metrics, DifferenceIsAMinusBIn255ths) {
    Image a(3, 2);
    PreciseImage b(3, 2);
    a.pixel(2, 1)[2] = 0.25f;
    b.pixel(2, 1)[2] = 0.5;
    const ImageError error = image_error(a, b);
    EXPECT_EQ(error.all.linf, 63.75);
    EXPECT_EQ(error.of_channel[2].mean, -63.75 / 6);
    EXPECT_EQ(error.worst.e, -63.75);
    EXPECT_EQ(error.worst.column, 2);
    EXPECT_EQ(error.worst.row, 1);
    EXPECT_EQ(error.worst.channel, 2u);
    EXPECT_EQ(image_error(b, a).worst.e, 63.75);
    EXPECT_EQ(image_error(a, a).all.linf, 0);
}

TEST(Metrics, SmallErrorsOfDoubleImagesAreNotLostInFloat) {
    PreciseImage a(1, 1), b(1, 1);
    a.rgba = {1 + 1e-12, 1, 1, 1};
    b.rgba = {1, 1, 1, 1};
    // 1 + 1e-12 is rounded to a multiple of 2^-52, an error of up to 2^-53.
    EXPECT_NEAR(image_error(a, b).all.linf, 255e-12, 255 * 0x1p-53);
}

TEST(Metrics, CompareStoredCodesOfBothDepths) {
    CodedImage a(2, 1, 1, 8), b(2, 1, 1, 8), c(2, 1, 1, 16);
    a.codes = {10, 200};
    b.codes = {13, 200};
    c.codes = {10 * 257, 200 * 257 - 257};
    EXPECT_EQ(measure(difference(a, b)).all.mean, -1.5);
    EXPECT_EQ(measure(difference(a, b)).channels, std::vector<std::string>{"Y"});
    EXPECT_EQ(difference(a, c).e, (std::vector<double>{0, 1}));
    EXPECT_EQ(difference(c, c).e, (std::vector<double>{0, 0}));
}

TEST(Metrics, RefuseImagesThatCannotBeCompared) {
    expect_error([] { image_error(Image(3, 2), Image(2, 3)); }, {"3 x 2", "2 x 3"});
    expect_error([] { difference(CodedImage(1, 1, 3, 8), CodedImage(1, 1, 4, 8)); },
                 {"channels", "3 and 4"});
    Image a(3, 2);
    a.pixel(1, 1)[3] = std::numeric_limits<float>::quiet_NaN();
    expect_error([&] { image_error(a, Image(3, 2)); }, {"(1, 1)", "channel A", "not finite"});
}

}  // namespace
}  // namespace lamina
