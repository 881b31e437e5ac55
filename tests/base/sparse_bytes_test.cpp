// SPDX-License-Identifier: Apache-2.0
#include "base/memory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace lamina {
namespace {

// Sets intervals of any length, across pages or within one, over bytes that were set before.
TEST(SparseBytes, HoldWhatWasSetLast) {
    constexpr std::size_t size = 20000;
    constexpr std::uint8_t background = 63;
    SparseBytes bytes(size, background);
    std::vector<std::uint8_t> expected(size, background);
    std::mt19937 random(3);
    for (int round = 0; round < 200; ++round) {
        const std::size_t first = random() % size;
        std::vector<std::uint8_t> run(std::min<std::size_t>(1 + random() % 9000, size - first));
        const bool empty = round % 3 == 0;
        for (std::uint8_t& byte : run)
            byte = empty ? background : static_cast<std::uint8_t>(random() % 256);
        bytes.set(first, run);
        std::ranges::copy(run, expected.begin() + static_cast<std::ptrdiff_t>(first));
        const std::size_t single = random() % size;
        bytes.set(single, expected[single] = static_cast<std::uint8_t>(random() % 256));
    }
    for (std::size_t i = 0; i < size; ++i) ASSERT_EQ(bytes[i], expected[i]) << i;
    EXPECT_EQ(bytes.count(background), std::ranges::count(expected, background));
}

TEST(SparseBytes, FindsTheFirstPlaceOfAValue) {
    constexpr std::size_t size = 10000;
    for (const std::uint8_t background : {std::uint8_t{0}, std::uint8_t{63}}) {
        SparseBytes bytes(size, background);
        for (const std::size_t place : {17, 5000, 9999}) bytes.set(place, 7);
        EXPECT_EQ(bytes.find(7, 0, size), 17u);
        EXPECT_EQ(bytes.find(7, 17, size), 17u);
        EXPECT_EQ(bytes.find(7, 18, size), 5000u);
        EXPECT_EQ(bytes.find(7, 5001, 9999), 9999u);  // no 7 before place 9999
        EXPECT_EQ(bytes.find(7, 5001, size), 9999u);
        EXPECT_EQ(bytes.find(background, 17, size), 18u);
        EXPECT_EQ(bytes.find(7, 30, 30), 30u);
        EXPECT_EQ(bytes.find(7, size, size), size);
    }
}

}  // namespace
}  // namespace lamina
