// SPDX-License-Identifier: Apache-2.0
#include "slicing/gl_row_bands.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <utility>
#include <vector>

namespace lamina {
namespace {

// Draws a frame whose rows take `ms(row)` each. Returns the times of its dispatches.
std::vector<double> times_of_frame(RowPace& pace, int height,
                                   const std::function<double(int)>& ms) {
    std::vector<double> times;
    double all = 0;
    for (int row = 0; row < height;) {
        const int rows = pace.next(height - row);
        EXPECT_GT(rows, 0);
        EXPECT_LE(rows, height - row);
        double time = 0;
        for (int i = 0; i < rows; ++i) time += ms(row + i);
        if (pace.wants_time()) pace.took(rows, time);
        times.push_back(time);
        all += time;
        row += rows;
    }
    pace.frame_took(height, all);
    return times;
}

TEST(RowPace, SoftwareGetsBandsOfAFixedNumberOfRows) {
    RowPace pace(48, false);
    EXPECT_FALSE(pace.wants_time());
    EXPECT_EQ(pace.next(600), 48);
    EXPECT_EQ(pace.next(7), 7);
}

TEST(RowPace, FastFramesAreOneDispatchAfterTheFirst) {
    RowPace pace(600, true);
    const auto fast = [](int) { return .005; };
    EXPECT_GT(times_of_frame(pace, 600, fast).size(), 3u);
    EXPECT_EQ(times_of_frame(pace, 600, fast).size(), 1u);
}

TEST(RowPace, AProgramsFirstUseMakesNoFrameSlow) {
    RowPace pace(600, true);
    bool used = false;
    times_of_frame(pace, 600, [&](int) { return std::exchange(used, true) ? .005 : 300.0; });
    EXPECT_LE(times_of_frame(pace, 600, [](int) { return .005; }).size(), 2u);
}

// Rows of the middle third take 10 ms each, the others nothing. A dispatch grows by at most a
// factor of 4, so the first that meets slow rows may take long once.
TEST(RowPace, SlowFramesAreDividedAfterTheFirst) {
    RowPace pace(600, true);
    const auto uneven = [](int row) { return row >= 200 && row < 400 ? 10.0 : 0.0; };
    times_of_frame(pace, 600, uneven);
    for (int frame = 0; frame < 3; ++frame)
        EXPECT_LE(std::ranges::max(times_of_frame(pace, 600, uneven)), 100) << frame;
}

}  // namespace
}  // namespace lamina
