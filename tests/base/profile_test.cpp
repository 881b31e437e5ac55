// SPDX-License-Identifier: Apache-2.0
#include "base/profile.h"

#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <thread>
#include <vector>

namespace lamina {
namespace {

TEST(ProfileTest, AStageWithoutAProfileMeasuresTime) {
    ASSERT_EQ(Profile::recording(), nullptr);
    Stage stage("work");
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    const double milliseconds = stage.end();
    EXPECT_GE(milliseconds, 2);            // sleep_for() sleeps at least so long
    EXPECT_EQ(stage.end(), milliseconds);  // the first call has ended it
}

TEST(ProfileTest, StagesNest) {
    Profile profile;
    {
        const Stage outer("outer");
        const Stage inner("inner");
    }
    ASSERT_EQ(profile.spans().size(), 2u);
    const Profile::Span &inner = profile.spans()[0], &outer = profile.spans()[1];
    EXPECT_STREQ(inner.name, "inner");
    EXPECT_STREQ(outer.name, "outer");
    EXPECT_LE(outer.begin_ns, inner.begin_ns);
    EXPECT_LE(inner.begin_ns, inner.end_ns);
    EXPECT_LE(inner.end_ns, outer.end_ns);
    EXPECT_EQ(inner.row, Profile::first_row);
    EXPECT_EQ(outer.row, Profile::first_row);
}

TEST(ProfileTest, AStageEndsOnce) {
    Profile profile;
    {
        Stage stage("work");
        stage.count("bytes", 7);
        stage.end();
    }
    ASSERT_EQ(profile.spans().size(), 1u);
    EXPECT_STREQ(profile.spans()[0].counts[0].name, "bytes");
    EXPECT_EQ(profile.spans()[0].counts[0].value, 7);
    EXPECT_EQ(profile.spans()[0].counts[1].name, nullptr);
}

TEST(ProfileTest, EveryThreadHasARow) {
    constexpr int threads = 4, stages = 1000;
    Profile profile;
    std::vector<std::thread> crew;
    for (int i = 0; i < threads; ++i) {
        crew.emplace_back([] {
            for (int k = 0; k < stages; ++k) const Stage stage("work");
        });
    }
    for (std::thread& thread : crew) thread.join();
    // Rows: OpenGL's, that of this thread (which has no stage), and at most one for each thread,
    // because ids of ended threads may be used again.
    EXPECT_LE(profile.row_count(), 2 + threads);
    EXPECT_GT(profile.row_count(), 2);
    EXPECT_EQ(profile.spans().size(), std::size_t{threads * stages});
    for (const Profile::Span& span : profile.spans()) {
        EXPECT_GT(span.row, Profile::first_row);
        EXPECT_LT(span.row, profile.row_count());
    }
}

TEST(ProfileTest, KeepsTheFirstSpansAndCountsTheOthers) {
    Profile profile;
    for (std::size_t i = 0; i < Profile::most_spans - 1; ++i) profile.add("kept", 0, 1, {});
    EXPECT_EQ(profile.spans_left_out(), 0);
    profile.add_opengl("last", 0, 1);
    profile.add("lost", 0, 1, {});
    profile.add_opengl("lost", 0, 1);
    ASSERT_EQ(profile.spans().size(), Profile::most_spans);
    EXPECT_STREQ(profile.spans().back().name, "last");
    EXPECT_EQ(profile.spans_left_out(), 2);
}

TEST(ProfileTest, RecordsUntilItsEnd) {
    {
        const Profile profile;
        EXPECT_EQ(Profile::recording(), &profile);
    }
    EXPECT_EQ(Profile::recording(), nullptr);
    const Stage stage("after it");  // not recorded
}

}  // namespace
}  // namespace lamina
