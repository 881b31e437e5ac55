// SPDX-License-Identifier: Apache-2.0
#include "model/frame_history.h"

#include <gtest/gtest.h>

namespace lamina::view {
namespace {

using Stages = std::vector<std::pair<std::string, double>>;

FrameStatistics statistics_of(double ms, std::map<std::string, double> stages) {
    FrameStatistics statistics;
    statistics.draw_ms = ms;
    statistics.stages_ms = std::move(stages);
    return statistics;
}

TEST(FrameHistory, StagesAddUpToTheFrame) {
    FrameHistory history;
    // The stage set_up contains tables and upload: 50 - 8 - 12 = 30 ms are its own.
    history.add(statistics_of(100, {{"facts", 20},
                                    {"plan", 5},
                                    {"set_up", 50},
                                    {"tables", 8},
                                    {"upload", 12},
                                    {"draw", 15}}),
                false);
    EXPECT_EQ(history.frames()[0].stages, (Stages{{"facts", 20},
                                                  {"plan", 5},
                                                  {"set_up", 30},
                                                  {"tables", 8},
                                                  {"upload", 12},
                                                  {"draw", 15},
                                                  {"other", 10}}));
    // Statistics keep the times of stages that this frame did not repeat: they are left out.
    history.add(statistics_of(20, {{"facts", 2},
                                   {"plan", 1},
                                   {"set_up", 50},
                                   {"tables", 8},
                                   {"upload", 12},
                                   {"draw", 16},
                                   {"order", 0}}),
                true);
    EXPECT_EQ(history.frames()[1].stages,
              (Stages{{"facts", 2}, {"plan", 1}, {"draw", 16}, {"other", 1}}));
    EXPECT_EQ(history.longest_ms(), 100);
    EXPECT_EQ(history.median_ms(true), 20);
    // Stages and frames are timed by separate clock reads: a stage is cut to the frame's time.
    history.add(statistics_of(10, {{"draw", 10.5}}), true);
    EXPECT_EQ(history.frames()[2].stages, (Stages{{"draw", 10}}));
}

TEST(FrameHistory, KeepsTheLastFrames) {
    FrameHistory history;
    EXPECT_EQ(history.longest_ms(), 0);
    EXPECT_EQ(history.median_ms(false), 0);
    for (std::size_t i = 0; i < FrameHistory::most_frames + 10; ++i)
        history.add(statistics_of(static_cast<double>(i), {}), false);
    EXPECT_EQ(history.frames().size(), FrameHistory::most_frames);
    EXPECT_EQ(history.frames().front().ms, 10);
}

}  // namespace
}  // namespace lamina::view
