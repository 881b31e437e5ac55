// SPDX-License-Identifier: Apache-2.0
#include "volume/range_answers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace lamina {
namespace {

template <typename T>
void expect_right_answers(SampleType type, std::size_t count) {
    BrickRanges ranges(count, type);
    std::mt19937 random(5);
    // A hole of several thousand bricks lies among the others.
    const std::size_t hole = count / 4, hole_end = count / 4 * 3;
    for (std::size_t i = 0; i < count; i += 1 + random() % 3) {
        if (i >= hole && i < hole_end) continue;
        const auto lo = static_cast<T>(random() % 200);
        ranges.set(i, lo, static_cast<T>(lo + static_cast<T>(random() % 50)));
    }
    const auto compute = [](const ValueRange& range) {
        return static_cast<std::uint32_t>(1000 * range.hi + range.lo);
    };
    const RangeAnswers<std::uint32_t> answers(ranges, compute);
    RangeAnswers<std::uint32_t>::Reader reader(answers);
    for (std::size_t i = 0; i < count; ++i) {
        const BrickRange range = ranges[i];
        ASSERT_EQ(reader[i], compute({range.lo, range.hi})) << i;
    }
    for (const std::size_t first : {std::size_t{0}, hole - 1, hole + 1, hole_end - 2049}) {
        std::vector<std::uint32_t> filled(std::min<std::size_t>(4500, count - first));
        reader.fill(first, filled);
        for (std::size_t i = 0; i < filled.size(); ++i)
            ASSERT_EQ(filled[i], reader[first + i]) << first << " + " << i;
        bool zero = true;
        for (std::size_t i = first; i < first + filled.size(); ++i)
            zero = zero && ranges[i].lo == 0 && ranges[i].hi == 0;
        EXPECT_EQ(ranges.all_zero(first, filled.size()), zero);
    }
}

TEST(RangeAnswers, MatchAnswersComputedForEachRange) {
    expect_right_answers<std::uint8_t>(SampleType::uint8, 15000);
    expect_right_answers<std::int16_t>(SampleType::int16, 15000);
    expect_right_answers<float>(SampleType::float32, 15000);
}

// There are so many bricks that the constructor computes the answers for all ranges.
TEST(RangeAnswers, MatchAnswersComputedForEachRangeOfManyBytes) {
    expect_right_answers<std::uint8_t>(SampleType::uint8, (1 << 20) + 1);
}

}  // namespace
}  // namespace lamina
