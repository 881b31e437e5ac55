// SPDX-License-Identifier: Apache-2.0
#include "volume/range_answers.h"

#include <gtest/gtest.h>

#include <random>

namespace lamina {
namespace {

template <typename T>
void expect_right_answers(SampleType type, std::size_t count) {
    BrickRanges ranges(count, type);
    std::mt19937 random(5);
    for (std::size_t i = 0; i < count; i += 1 + random() % 3) {
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
}

TEST(RangeAnswers, AreThoseOfEachRange) {
    expect_right_answers<std::uint8_t>(SampleType::uint8, 5000);
    expect_right_answers<std::int16_t>(SampleType::int16, 5000);
    expect_right_answers<float>(SampleType::float32, 5000);
}

// Bricks are so many that all ranges are answered at once.
TEST(RangeAnswers, OfManyBytesAreThoseOfEachRange) {
    expect_right_answers<std::uint8_t>(SampleType::uint8, (1 << 20) + 1);
}

}  // namespace
}  // namespace lamina
