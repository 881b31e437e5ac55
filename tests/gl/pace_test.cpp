// SPDX-License-Identifier: Apache-2.0
#include "gl/pace.h"

#include <algorithm>
#include <chrono>
#include <functional>
#include <thread>
#include <utility>
#include <vector>

#include "gl_fixture.h"

namespace lamina::gl {
namespace {

// Draws a frame whose rows take `ms(row)` each, on a GPU without a queue: each dispatch is done
// before the next one is asked for. Returns the times of its dispatches.
std::vector<double> times_of_frame(WorkPace& pace, int height,
                                   const std::function<double(int)>& ms) {
    std::vector<double> times;
    int waited_for = 0;
    double since_waiting = 0;
    const auto wait = [&](int row) {
        if (row > waited_for) pace.took(row - waited_for, since_waiting);
        waited_for = row;
        since_waiting = 0;
    };
    for (int row = 0; row < height;) {
        const int rows = pace.next(height - row);
        EXPECT_GT(rows, 0);
        EXPECT_LE(rows, height - row);
        double time = 0;
        for (int i = 0; i < rows; ++i) time += ms(row + i);
        since_waiting += time;
        times.push_back(time);
        row += rows;
        if (pace.wants_time(since_waiting)) wait(row);
    }
    wait(height);
    pace.frame_ended();
    return times;
}

TEST(WorkPace, SoftwareGetsDispatchesOfAFixedSize) {
    WorkPace pace(48, 8, false);
    EXPECT_FALSE(pace.wants_time(0));
    EXPECT_FALSE(pace.wants_time(1e6));
    EXPECT_EQ(pace.next(600), 48);
    EXPECT_EQ(pace.next(7), 7);
}

TEST(WorkPace, FastFramesAreOneDispatchAfterTheFirst) {
    WorkPace pace(600, 8, true);
    const auto fast = [](int) { return .005; };
    EXPECT_GT(times_of_frame(pace, 600, fast).size(), 3u);
    EXPECT_FALSE(pace.wants_time(0));
    EXPECT_EQ(times_of_frame(pace, 600, fast).size(), 1u);
}

TEST(WorkPace, AProgramsFirstUseMakesNoFrameSlow) {
    WorkPace pace(600, 8, true);
    bool used = false;
    times_of_frame(pace, 600, [&](int) { return std::exchange(used, true) ? .005 : 300.0; });
    EXPECT_LE(times_of_frame(pace, 600, [](int) { return .005; }).size(), 2u);
}

// Rows of the middle third take 10 ms each, the others nothing. A dispatch grows by at most a
// factor of 4, so the first that meets slow rows may take long once.
TEST(WorkPace, SlowFramesAreDividedAfterTheFirst) {
    WorkPace pace(600, 8, true);
    const auto uneven = [](int row) { return row >= 200 && row < 400 ? 10.0 : 0.0; };
    times_of_frame(pace, 600, uneven);
    for (int frame = 0; frame < 3; ++frame)
        EXPECT_LE(std::ranges::max(times_of_frame(pace, 600, uneven)), WorkPace::most_ms) << frame;
}

// After a view whose rows take 10 ms, dispatches have 8 rows. Each wait of later frames, at their
// ends and 100 ms after the last one, lets them grow by 1 / .9.
TEST(WorkPace, DispatchesGrowAgainAfterASlowView) {
    WorkPace pace(600, 8, true);
    times_of_frame(pace, 600, [](int) { return .5; });
    times_of_frame(pace, 600, [](int) { return 10.0; });
    const auto now = [](int) { return .5; };
    const std::size_t slow = times_of_frame(pace, 600, now).size();
    for (int frame = 0; frame < 9; ++frame) times_of_frame(pace, 600, now);
    const std::vector<double> times = times_of_frame(pace, 600, now);
    EXPECT_LT(times.size(), slow / 4);
    EXPECT_LE(std::ranges::max(times), WorkPace::wanted_ms);
}

// As it is where dispatches are so small that a GPU waits for them more than it works.
TEST(WorkPace, ShortFramesForgetSlowUnitsSoon) {
    WorkPace pace(600, 8, true);
    times_of_frame(pace, 600, [](int) { return 10.0; });
    const auto fast = [](int) { return .02; };
    // From 10 ms to 50 / 600 is less than 2^7.
    for (int frame = 0; frame < 7; ++frame) times_of_frame(pace, 600, fast);
    EXPECT_EQ(times_of_frame(pace, 600, fast).size(), 1u);
}

using WorkPaceInAContext = GlTest;

// Rows would seem to take 7.5 ms each, so that no dispatch had more than 8.
TEST_F(WorkPaceInAContext, CountsNoTimeInWhichTheHostWorks) {
    WorkPace pace(100, 8, true);
    std::size_t count = 0;
    pace.begin_frame();
    for (int left = 100; left > 0; ++count) {
        std::this_thread::sleep_for(std::chrono::milliseconds(60));
        const int units = pace.next(left);
        pace.dispatched(units);
        left -= units;
    }
    pace.end_frame();
    EXPECT_LT(count, 13u);  // 100 / 8
}

// The first dispatch is not counted, so that the second has no more rows. How many the others have
// depends on the clock.
TEST_F(WorkPaceInAContext, GoesAheadStepByStepInTheFirstFrame) {
    WorkPace pace(100, 8, true);
    const auto dispatches = [&] {
        std::vector<int> units;
        pace.begin_frame();
        for (int left = 100; left > 0; left -= units.back()) {
            units.push_back(pace.next(left));
            pace.dispatched(units.back());
        }
        pace.end_frame();
        return units;
    };
    const std::vector<int> units = dispatches();
    ASSERT_GE(units.size(), 4u);
    EXPECT_EQ(units[0], 8);
    EXPECT_EQ(units[1], 8);
    EXPECT_LE(dispatches().size(), units.size());
}

}  // namespace
}  // namespace lamina::gl
