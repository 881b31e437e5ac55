// SPDX-License-Identifier: Apache-2.0
#include "annotation/numbers.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lamina {
namespace {

using Texts = std::vector<std::string>;

TEST(Numbers, RoundDownToOneTwoOrFive) {
    EXPECT_EQ(round_number_up_to(1), 1);
    EXPECT_EQ(round_number_up_to(1.99), 1);
    EXPECT_EQ(round_number_up_to(2), 2);
    EXPECT_EQ(round_number_up_to(4.9), 2);
    EXPECT_EQ(round_number_up_to(9.99), 5);
    EXPECT_EQ(round_number_up_to(1000), 1000);
    EXPECT_EQ(round_number_up_to(std::nextafter(1000, 0)), 500);
    EXPECT_EQ(round_number_up_to(0.3), 0.2);
    EXPECT_EQ(round_number_up_to(1e-300), 1e-300);
    EXPECT_EQ(round_number_up_to(7e299), 5e299);
}

TEST(Numbers, TicksAreMultiplesOfARoundStepInTheRange) {
    for (const auto& [lo, hi] : {std::pair(0.0, 255.0),
                                 {-1024.0, 3071.0},
                                 {0.013, 0.0171},
                                 {-3e-7, 8e-7},
                                 {1e9, 1e9 + 30}}) {
        for (const int most : {2, 3, 6, 11}) {
            const Ticks ticks = ticks_between(lo, hi, most);
            EXPECT_LE(ticks.values.size(), std::size_t(most));
            EXPECT_EQ(round_number_up_to(ticks.step), ticks.step);
            for (const double value : ticks.values) {
                EXPECT_GE(value, lo);
                EXPECT_LE(value, hi);
                // A multiple up to the rounding of the product.
                const double n = value / ticks.step;
                EXPECT_NEAR(n, std::round(n), 1e-9 * std::max(1.0, std::abs(n)));
            }
            // The next smaller round step, at least two fifths of this one, makes too many.
            EXPECT_GT((hi - lo) / (0.4 * ticks.step) + 1, most);
        }
    }
}

// Ends that are neighbours among doubles, or farther apart than the largest round number.
TEST(Numbers, TicksEndForEveryRange) {
    for (const auto& [lo, hi] : {std::pair(1e16, 1e16 + 2),
                                 {-1e300, 1e300},
                                 {0.0, 5e-324},
                                 {3.0, std::nextafter(3.0, 4.0)}}) {
        const Ticks ticks = ticks_between(lo, hi, 5);
        EXPECT_LE(ticks.values.size(), 5u);
        for (const std::string& text : number_texts(ticks.values, ticks.step))
            EXPECT_LT(text.size(), 40u);
    }
}

TEST(Numbers, HaveAsManyDigitsAsTheirStepNeeds) {
    EXPECT_EQ(number_texts({0, 50, 100}, 50), (Texts{"0", "50", "100"}));
    EXPECT_EQ(number_texts({-0.5, 0, 0.5}, 0.5), (Texts{"\u22120.5", "0.0", "0.5"}));
    EXPECT_EQ(number_texts({0.015, 0.02}, 0.005), (Texts{"0.015", "0.020"}));
    EXPECT_EQ(number_texts({0, 2e6, 4e6}, 2e6), (Texts{"0", "2e6", "4e6"}));
    EXPECT_EQ(number_texts({1e-5, 1.5e-5}, 5e-6), (Texts{"1.0e\u22125", "1.5e\u22125"}));
    EXPECT_EQ(number_text(0.2), "0.2");
    EXPECT_EQ(number_text(-1e-7), "\u22121e\u22127");
}

TEST(Numbers, FormatsAreOneFieldWithTextAroundIt) {
    for (const char* const good : {"{}", "{:.0f}", "{} K", "T = {:.3g} \u00b0C", "{:.17e}"})
        EXPECT_EQ(mistake_in_format(good), std::nullopt) << good;
    for (const char* const bad : {"", "K", "{", "}", "}{", "{}{}", "{0}", "{:.99f}", "{:1000000}",
                                  "{:.2d}", "{:.f}", "{:.-1f}", "{{}}", "{:>9}", "{:.{}f}"})
        EXPECT_NE(mistake_in_format(bad), std::nullopt) << bad;
    EXPECT_EQ(formatted("T = {:.2f} K", -3.14159), "T = \u22123.14 K");
    EXPECT_EQ(formatted("{}", 1000), "1000");
}

}  // namespace
}  // namespace lamina
