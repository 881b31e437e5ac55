// SPDX-License-Identifier: Apache-2.0
#include "papers/lamar.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lamina::papers {
namespace {

TEST(Ramp, IsStraightIfExact) {
    const Curve ramp = exact_ramp(0.5);
    ASSERT_EQ(ramp.size(), 256u);
    EXPECT_EQ(ramp[0], 0);
    EXPECT_EQ(ramp[100], 50);
    EXPECT_EQ(ramp[255], 127.5);
}

TEST(Ramp, HasTheOpacityOfItsOnlySample) {
    const Curve ramp = composite_ramp({.samples = 1});
    for (int x = 0; x < ramp_width; ++x) EXPECT_EQ(ramp[static_cast<std::size_t>(x)], x);
}

// Repeats OVER in whole numbers with colour 1: fragment t over b is
// round(t) + round(b (255 - t) / 255).
TEST(Ramp, IsTheOperatorAppliedNTimes) {
    constexpr int samples = 64;
    const Curve ramp = composite_ramp({.samples = samples});
    for (int x = 0; x < 255; ++x) {
        const double alpha = 1 - std::pow(1 - x / 255.0, 1.0 / samples);
        const int t = static_cast<int>(std::floor(255 * alpha + 1e-9));
        int b = 0;
        for (int i = 0; i < samples; ++i) b = t + (2 * b * (255 - t) + 255) / 510;
        EXPECT_EQ(ramp[static_cast<std::size_t>(x)], b) << x;
    }
}

TEST(Ramp, ATreeOfOneLevelIsStraightCompositing) {
    EXPECT_EQ(composite_ramp_tree({.samples = 256}, {256}), composite_ramp({.samples = 256}));
}

TEST(Ramp, SixteenBitsAreInTheSameUnits) {
    RampSetting setting{.samples = 1};
    setting.emulation = {.bits = 16, .alpha = AlphaRounding::nearest};
    // 257 codes of 16 bits are one code of 8 bits, so x/255 is represented exactly.
    EXPECT_EQ(composite_ramp(setting), exact_ramp(1));
}

TEST(CurveNorms, AreThoseOfTheDifferences) {
    const ErrorNorms e = error_of({1, 2, 3, 4}, {1, 2, 0, 8});
    EXPECT_EQ(e.linf, 4);
    EXPECT_EQ(e.mean, -0.25);  // (3 - 4) / 4
    EXPECT_EQ(e.l2, 2.5);      // sqrt((9 + 16) / 4)
}

TEST(CurveShape, CountsFallsLevelsAndTheFirstShown) {
    const Curve curve{0, 0, 3, 2, 2, 5, 1};
    EXPECT_EQ(decreases(curve), 2);
    EXPECT_EQ(largest_drop(curve), 4);
    EXPECT_EQ(levels(curve), 5);
    EXPECT_EQ(first_shown(curve), 2);
    EXPECT_EQ(first_shown(Curve(ramp_width, 0.0)), ramp_width);
}

// Section 5.2: with a code of .1 and period 10, one slab in 10 is rounded up. Nine slabs miss it at
// one place in ten, and at the others meet it 0 .. 8 slabs late, equally often.
TEST(DitherSpans, AgreeWithThePapersExample) {
    const SpanLoss loss = span_loss({0.1, 9, Dither{.period = 10}});
    EXPECT_DOUBLE_EQ(loss.lost, 0.1);
    EXPECT_DOUBLE_EQ(loss.mean_shift, 4);
    EXPECT_EQ(loss.largest_shift, 8);
    // The sum of codes is 1 at nine places and 0 at one; .9 would be right.
    EXPECT_NEAR(loss.sum_error, std::sqrt(0.9 * 0.01 + 0.1 * 0.81), 1e-15);
    EXPECT_EQ(span_loss({0.1, 9, Dither{.period = 9}}).lost, 1);
}

TEST(DitherSpans, LoseNothingOverWholePeriods) {
    const SpanLoss loss = span_loss({0.5, 64, Dither{.period = 16}});
    EXPECT_EQ(loss.lost, 0);
    EXPECT_EQ(loss.sum_error, 0);
}

}  // namespace
}  // namespace lamina::papers
