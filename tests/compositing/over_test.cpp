// SPDX-License-Identifier: Apache-2.0
// OVER on n-bit codes, compared with LaMar 2004, Tables 2 and 3, and with exact fractions.
#include "compositing/codes.h"

#include <gtest/gtest.h>

#include <array>
#include <random>

#include "compositing/fixed_ray.h"
#include "oracles.h"

namespace lamina {
namespace {

constexpr std::array both_roundings = {OverRounding::separate, OverRounding::fused};

bool is_fused(OverRounding rounding) {
    return rounding == OverRounding::fused;
}

std::uint32_t over4(std::uint32_t f, std::uint32_t b) {
    return over(OverRounding::separate, 15, f, b, 15);
}

// The paper prints each row of Table 2 as wide cells: as f goes from 0 to 15 the values b, b + 1,
// ..., 15 follow each other and none is left out.
TEST(Over, GivesTheCellsOfTable2) {
    for (std::uint32_t b = 0; b <= 15; ++b) {
        EXPECT_EQ(over4(0, b), b);
        EXPECT_EQ(over4(15, b), 15u);
        for (std::uint32_t f = 1; f <= 15; ++f) {
            EXPECT_TRUE(over4(f, b) == over4(f - 1, b) || over4(f, b) == over4(f - 1, b) + 1)
                << f << " over " << b;
            EXPECT_EQ(over4(f, b), over4(b, f));
        }
    }
    for (std::uint32_t f = 0; f <= 15; ++f) {
        EXPECT_EQ(over4(f, 0), f);
        EXPECT_EQ(over4(f, 14), f <= 7 ? 14u : 15u);  // section 4.2, below Table 2
    }
}

// Rows are repeated compositions of f over 0. Row 4 is what the arithmetic gives: 4 + 9 * 11 / 15 =
// 10.6; the paper prints 10 as its fourth entry (docs/numerics.md, "Where the papers are wrong").
TEST(Over, GivesTable3) {
    struct Row {
        std::uint32_t f;
        std::array<std::uint32_t, 11> values;
    };
    const std::array<Row, 7> rows = {{{1, {1, 2, 3, 4, 5, 6, 7, 8, 8, 8, 8}},
                                      {2, {2, 4, 5, 6, 7, 8, 9, 10, 11, 12, 12}},
                                      {3, {3, 5, 7, 9, 10, 11, 12, 13, 13, 13, 13}},
                                      {4, {4, 7, 9, 11, 12, 13, 14, 14, 14, 14, 14}},
                                      {8, {8, 12, 14, 15, 15, 15, 15, 15, 15, 15, 15}},
                                      {10, {10, 13, 14, 15, 15, 15, 15, 15, 15, 15, 15}},
                                      {15, {15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15}}}};
    for (const Row& row : rows) {
        std::uint32_t b = 0;
        for (const std::uint32_t expected : row.values) {
            b = over4(row.f, b);
            EXPECT_EQ(b, expected) << "f = " << row.f;
        }
    }
}

TEST(Over, IsTheExactFractionRoundedForEveryTripleOf4Bits) {
    for (const OverRounding rounding : both_roundings) {
        for (std::uint32_t c = 0; c <= 15; ++c) {
            for (std::uint32_t t = 0; t <= 15; ++t) {
                for (std::uint32_t b = 0; b <= 15; ++b) {
                    EXPECT_EQ(over(rounding, c, t, b, 15),
                              oracle::over(is_fused(rounding), c, t, b, 15));
                    for (std::uint32_t a = 0; a <= 15; ++a) {
                        EXPECT_EQ(under(rounding, c, t, b, a, 15),
                                  oracle::under(is_fused(rounding), c, t, b, a, 15));
                    }
                }
            }
        }
    }
}

class OverBits : public testing::TestWithParam<int> {};

TEST_P(OverBits, IsTheExactFractionRounded) {
    const std::uint32_t largest = largest_code(GetParam());
    std::mt19937 random(7);
    // Every fourth operand is 0 or the largest code, with which sums and products are extreme.
    const auto code = [&] {
        const auto choice = static_cast<std::uint32_t>(random());
        if (choice % 8 == 0) return largest;
        return choice % 8 == 1 ? 0 : static_cast<std::uint32_t>(random()) % (largest + 1);
    };
    for (int i = 0; i < 200000; ++i) {
        const std::uint32_t c = code(), t = code(), b = code(), a = code();
        for (const OverRounding rounding : both_roundings) {
            const std::uint32_t result = over(rounding, c, t, b, largest);
            ASSERT_EQ(result, oracle::over(is_fused(rounding), c, t, b, largest))
                << c << " " << t << " " << b;
            ASSERT_LE(result, largest);
            ASSERT_EQ(under(rounding, c, t, b, a, largest),
                      oracle::under(is_fused(rounding), c, t, b, a, largest))
                << c << " " << t << " " << b << " " << a;
        }
    }
}

// For any fragments, associated colour is at most the opacity, and both are at most M.
TEST_P(OverBits, AccumulatesColorBelowOpacity) {
    const std::uint32_t largest = largest_code(GetParam());
    std::mt19937 random(11);
    for (const OverRounding rounding : both_roundings) {
        std::uint32_t color = 0, alpha = 0;
        for (int i = 0; i < 2000; ++i) {
            if (i % 20 == 0) color = alpha = 0;
            const auto c = static_cast<std::uint32_t>(random() % (largest + 1ul));
            const auto t = static_cast<std::uint32_t>(random() % (largest + 1ul));
            color = under(rounding, c, t, color, alpha, largest);
            alpha = under(rounding, largest, t, alpha, alpha, largest);
            ASSERT_LE(color, alpha);
            ASSERT_LE(alpha, largest);
        }
    }
}

// M * t / M needs no rounding, so both kinds of rounding round the same product once.
TEST_P(OverBits, SeparateRoundingEqualsFusedForAlpha) {
    const std::uint32_t largest = largest_code(GetParam());
    std::mt19937 random(13);
    for (int i = 0; i < 100000; ++i) {
        const auto t = static_cast<std::uint32_t>(random() % (largest + 1ul));
        const auto b = static_cast<std::uint32_t>(random() % (largest + 1ul));
        const std::uint32_t separate = over(OverRounding::separate, largest, t, b, largest);
        ASSERT_EQ(separate, over(OverRounding::fused, largest, t, b, largest));
        for (const OverRounding rounding : both_roundings) {
            ASSERT_EQ(under(rounding, largest, t, b, b, largest), separate);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(All, OverBits, testing::Values(1, 2, 6, 8, 10, 12, 16));

// With 16 bits, (2 x + M) / (2 M) would overflow (docs/numerics.md, section 2).
TEST(Over, DoesNotOverflowWith16Bits) {
    for (const OverRounding rounding : both_roundings) {
        EXPECT_EQ(over(rounding, 65535, 65535, 65535, 65535), 65535u);
        EXPECT_EQ(over(rounding, 65535, 32768, 65535, 65535), 65535u);
        EXPECT_EQ(over(rounding, 0, 0, 65535, 65535), 65535u);
        EXPECT_EQ(under(rounding, 65535, 65535, 0, 0, 65535), 65535u);
    }
}

// The weight-rounding error (LaMar 2004, section 4.3): Figure 3's curves of colour 0.5, code 128,
// over rising opacity also fall; with fused rounding none does (docs/numerics.md, section 2).
TEST(Over, OnlySeparateHasTheWeightRoundingError) {
    for (const int samples : {16, 64, 256}) {
        for (const OverRounding rounding : both_roundings) {
            const Emulation emulation = {8, AlphaRounding::truncate, rounding, 1};
            int falls = 0;
            std::uint32_t previous = 0;
            for (int value = 0; value <= 255; ++value) {
                const double alpha = opacity_over(value / 255.0, 1.0 / samples);
                const std::vector<RaySample> ray(static_cast<std::size_t>(samples), {.5, alpha});
                const std::uint32_t color = composite_straight(ray, emulation).color;
                if (color < previous) ++falls;
                previous = color;
            }
            EXPECT_EQ(falls > 0, rounding == OverRounding::separate) << samples;
        }
    }
}

}  // namespace
}  // namespace lamina
