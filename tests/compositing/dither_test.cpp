// SPDX-License-Identifier: Apache-2.0
// Dithering along depth: LaMar 2004, section 5; docs/numerics.md, section 2.
#include "compositing/codes.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "compositing/fixed_ray.h"
#include "oracles.h"

namespace lamina {
namespace {

// The values are the published first outputs of splitmix64 for seed 0.
TEST(Dither, RandomNumbersAreThoseOfSplitMix64) {
    SplitMix64 random(0);
    EXPECT_EQ(random.next(), 0xe220a8397b1dcdafu);
    EXPECT_EQ(random.next(), 0x6e789e6aa1b965f4u);
    EXPECT_EQ(random.next(), 0x06c45d188009454fu);
    EXPECT_EQ(random.next(), 0xf88bb8a8724c81ecu);
}

TEST(Dither, RanksAreThePermutationOfNumerics) {
    for (const int period : {1, 2, 3, 4, 11, 16, 64, 256, 1000, max_dither_period}) {
        for (const std::uint64_t seed : {0ul, 1ul, 2ul, 0xfffffffful}) {
            const std::vector<std::uint32_t> ranks = dither_ranks(period, seed);
            const std::vector<int> expected = oracle::permutation(period, seed);
            EXPECT_TRUE(
                std::equal(ranks.begin(), ranks.end(), expected.begin(), expected.end(),
                           [](std::uint32_t a, int b) { return a == static_cast<unsigned>(b); }))
                << period << " " << seed;
            std::vector<std::uint32_t> sorted = ranks;
            std::sort(sorted.begin(), sorted.end());
            for (std::uint32_t i = 0; i < sorted.size(); ++i) ASSERT_EQ(sorted[i], i);
        }
    }
    EXPECT_NE(dither_ranks(16, 1), dither_ranks(16, 2));
}

// floor(P f) of the P slabs of a period show the code above a value, and the others the code below.
TEST(Dither, ShowsTheUpperCodeInProportionToTheRemainder) {
    for (const int period : {1, 4, 10, 11, 64, 256}) {
        const std::vector<std::uint32_t> ranks = dither_ranks(period, 5);
        for (const int whole : {0, 1, 127, 253}) {
            for (int eighth = 0; eighth < 8; ++eighth) {
                const double scaled = whole + eighth / 8.0;
                const int above = period * eighth / 8;  // exactly floor(P f)
                int counts[2] = {};
                for (const std::uint32_t rank : ranks) {
                    const int up =
                        static_cast<int>(dither_code(scaled, rank, period, 1, 255)) - whole;
                    ASSERT_TRUE(up == 0 || up == 1);
                    ++counts[up];
                }
                EXPECT_EQ(counts[1], above) << scaled << " of period " << period;
                EXPECT_EQ(counts[0], period - above);
            }
        }
    }
}

// The paper's example: 1.4 with period 10 is six 1s and four 2s, although in double precision 1.4 -
// 1 is a little less than .4.
TEST(Dither, GivesThePapersExample) {
    int sum = 0;
    for (std::uint32_t rank = 0; rank < 10; ++rank) {
        sum += static_cast<int>(dither_code(1.4, rank, 10, 1, 255));
    }
    EXPECT_EQ(sum, 14);
}

TEST(Dither, GivesMultiplesOfItsIncrement) {
    for (const int increment : {2, 3, 7}) {
        constexpr int period = 60;
        for (double scaled = 0; scaled < 250; scaled += 3.1) {
            double sum = 0;
            for (std::uint32_t rank = 0; rank < period; ++rank) {
                const std::uint32_t code = dither_code(scaled, rank, period, increment, 255);
                EXPECT_TRUE(code % static_cast<unsigned>(increment) == 0 || code == 255);
                EXPECT_LT(std::abs(code - scaled), increment);
                sum += code;
            }
            // floor() loses less than one of the period's increments.
            EXPECT_LE(sum / period, scaled + 1e-9);
            EXPECT_GT(sum / period, scaled - static_cast<double>(increment) / period - 1e-9);
        }
    }
}

TEST(Dither, LeavesTheSmallestAndLargestCodeUnchanged) {
    for (const std::uint32_t largest : {1u, 15u, 255u, 65535u}) {
        for (const int increment : {1, 2, 3, 7}) {
            for (std::uint32_t rank = 0; rank < 16; ++rank) {
                EXPECT_EQ(dither_code(largest, rank, 16, increment, largest), largest);
                EXPECT_EQ(dither_code(0, rank, 16, increment, largest), 0u);
                EXPECT_LE(dither_code(largest - .001, rank, 16, increment, largest), largest);
            }
        }
    }
}

// A ray of N = 2 P slabs that are too faint for 8 bits: it has nothing if undithered, and floor(P
// f) codes of 1 in each period if dithered. Colour has a permutation of its own.
TEST(Dither, AccumulatesRaysTooFaintForOneCode) {
    constexpr int period = 64;
    const std::vector<RaySample> ray(2 * period, {.3, .25 / 255});
    const Emulation emulation;  // 8 bits, truncate, separate
    EXPECT_EQ(composite_straight(ray, emulation).alpha, 0u);

    const Dither dither = {period, 9, true, 1};
    const std::vector<int> alpha_ranks = oracle::permutation(period, 9);
    const std::vector<int> color_ranks = oracle::permutation(period, 10);
    std::uint32_t color = 0, alpha = 0;
    for (std::size_t slab = ray.size(); slab-- > 0;) {
        const auto [c_whole, c_rest] = oracle::parts(255 * .3);
        const std::uint32_t c =
            c_whole + (color_ranks[slab % period] < std::floor(period * c_rest + 1e-9L) ? 1 : 0);
        const std::uint32_t t = alpha_ranks[slab % period] < 16 ? 1 : 0;
        color = oracle::over(false, c, t, color, 255);
        alpha = oracle::over(false, 255, t, alpha, 255);
    }
    const FixedPixel pixel = composite_straight(ray, emulation, dither);
    EXPECT_EQ(pixel.alpha, 32u);  // 2 * 16 codes of 1; OVER loses none below code 128
    EXPECT_EQ(pixel.alpha, alpha);
    EXPECT_EQ(pixel.color, color);
}

}  // namespace
}  // namespace lamina
