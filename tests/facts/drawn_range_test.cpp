// SPDX-License-Identifier: Apache-2.0
#include "facts/drawn_range.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "support/transfer_functions.h"

namespace lamina {
namespace {

using test::knot;

// A function that changes visibly only from 100 to 104: it is transparent below and constant above.
TransferFunction narrow() {
    return TransferFunction::linear({knot(0, {1, 0, 0}, 0), knot(100, {0, 1, 0}, 0),
                                     knot(102, {0, 1, 0}, 3), knot(104, {1, 1, 1}, 1),
                                     knot(60000, {1, 1, 1}, 1)});
}

TEST(ExactRange, IsAPowerOfTwoAroundWhatChanges) {
    const ValueRange range = exact_range(narrow(), {-3, 60000}, SampleType::uint16);
    EXPECT_LT(range.lo, 100);
    EXPECT_GT(range.hi, 104);
    // One of three overlapping halves of an interval (lower, middle, upper) holds whatever is
    // shorter than a quarter of the interval less two margins. So halving the range stops at less
    // than four times the length of 4 with its margins.
    EXPECT_LE(range.hi - range.lo, 32);
    EXPECT_EQ(std::exp2(std::round(std::log2(range.hi - range.lo))), range.hi - range.lo);
    EXPECT_EQ(range.lo, std::floor(range.lo));
}

TEST(ExactRange, HoldsTheWholeRangeIfAllOfItChanges) {
    const ValueRange range = exact_range(test::smooth(), {0, 1}, SampleType::float32);
    EXPECT_EQ(range, (ValueRange{0, 1}));
    const ValueRange bytes =
        exact_range(TransferFunction::linear({knot(0, {1, 1, 1}, 0), knot(255, {1, 1, 1}, 1)}),
                    {3, 250}, SampleType::uint8);
    EXPECT_EQ(bytes, (ValueRange{3, 259}));
}

TEST(ExactRange, IsNoNarrowerThanFloatsCanResolve) {
    const auto step =
        TransferFunction::linear({knot(1000, {1, 1, 1}, 0), knot(1000, {1, 1, 1}, 1)});
    const ValueRange floats = exact_range(step, {-1e9, 1e9}, SampleType::float32);
    EXPECT_GE(floats.hi - floats.lo, 1000 * 0x1p-24);
    // The width is at least 2^-28 of the range, which is 8, and at most twice that.
    EXPECT_LE(floats.hi - floats.lo, 16);
    EXPECT_LT(floats.lo, 1000);
    EXPECT_GT(floats.hi, 1000);
    const ValueRange bytes = exact_range(step, {0, 65535}, SampleType::uint16);
    EXPECT_LE(bytes.hi - bytes.lo, 16);
    EXPECT_EQ(bytes.lo, std::floor(bytes.lo));
}

constexpr std::array field{.1, .2, .4, .5, .7, .9, 9.97e36};

TEST(MeshWindow, HoldsWhatChangesWithAMargin) {
    const ValueRange window = mesh_window(narrow(), field, {-3, 60000});
    EXPECT_LT(window.lo, 100);
    EXPECT_GT(window.hi, 104);
    EXPECT_LE(window.hi - window.lo, 5);
}

TEST(MeshWindow, EndsWhereTheDataDo) {
    const ValueRange window = mesh_window(narrow(), field, {101, 9.97e36});
    EXPECT_EQ(window.lo, 101);
    EXPECT_GT(window.hi, 104);
    EXPECT_LE(window.hi, 105);
    EXPECT_EQ(mesh_window(test::smooth(), field, {0, 1}), (ValueRange{0, 1}));
}

TEST(MeshWindow, IsTheRangeIfNothingChangesThere) {
    EXPECT_EQ(mesh_window(narrow(), field, {200, 300}), (ValueRange{200, 300}));
    const auto one = TransferFunction::linear({knot(5, {1, 1, 1}, 1)});
    EXPECT_EQ(mesh_window(one, field, {0, 10}), (ValueRange{0, 10}));
}

// A step has no width of its own, so the distance of the values around it sets the width.
TEST(MeshWindow, IsAsWideAsTheValuesAroundAStep) {
    const auto step = TransferFunction::linear({knot(.5, {1, 1, 1}, 0), knot(.5, {1, 1, 1}, 1)});
    const ValueRange window = mesh_window(step, field, {.1, 9.97e36});
    EXPECT_LT(window.lo, .5);
    EXPECT_GT(window.hi, .5);
    EXPECT_LE(window.hi - window.lo, 1);
    EXPECT_GE(window.hi - window.lo, .1);
}

TEST(DrawnRange, HasAPowerOfTwoWidthForOneValue) {
    for (const double value : {0., 17181., -17181., 1e-30}) {
        const ValueRange range = drawn_range(narrow(), {value, value});
        const double width = range.hi - range.lo;
        EXPECT_EQ(range.lo, value);
        EXPECT_EQ(std::exp2(std::round(std::log2(width))), width) << value;
    }
}

}  // namespace
}  // namespace lamina
