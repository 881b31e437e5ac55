// SPDX-License-Identifier: Apache-2.0
#include "choice/automatic_transfer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "support/expect_error.h"

namespace lamina {
namespace {

TransferFunction function_of(const std::vector<double>& values) {
    std::vector<TransferKnot> knots;
    for (std::size_t i = 0; i < values.size(); ++i)
        knots.push_back({values[i], {glm::dvec3(i % 2 == 0 ? 0 : 1), i % 3 == 0 ? 1. : 2.}});
    return TransferFunction::linear(knots);
}

// stretched() either throws Error, because three points would get one value, or returns a function
// that can be written and read: its values ascend from one end of the range to the other.
TEST(StretchedTransfer, ValuesAscendWhateverTheRange) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> share(0, 1), exponent(-20, 300);
    int narrow = 0, stretched_well = 0;
    for (int round = 0; round < 2000; ++round) {
        std::vector<double> values{-1, 3};
        for (int i = 0; i < 20; ++i) values.push_back(-1 + 4 * share(random));
        // Neighbours as close as they can be, and steps.
        for (int i = 0; i < 5; ++i) values.push_back(std::nextafter(values[2 + i], 9));
        values.push_back(values[8]);
        std::ranges::sort(values);
        ValueRange range{(share(random) - .5) * std::pow(10, exponent(random)), 0};
        range.hi = round % 2 == 0 ? range.lo + std::pow(10, exponent(random))
                                  : range.lo + std::abs(range.lo) * 1e-14;
        if (!(range.lo < range.hi)) continue;
        try {
            const TransferFunction function = stretched(function_of(values), range);
            const auto knots = function.knots();
            EXPECT_EQ(knots.front().value, range.lo);
            EXPECT_EQ(knots.back().value, range.hi);
            ++stretched_well;
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find("is too narrow for the"), std::string::npos)
                << error.what();
            ++narrow;
        }
    }
    EXPECT_GT(narrow, 100);
    EXPECT_GT(stretched_well, 100);
}

TEST(StretchedTransfer, RefusesSingleValuesAndTooNarrowRanges) {
    expect_error([] { stretched(function_of({5}), {0, 1}); }, {"has a single value, 5"});
    expect_error(
        [] {
            stretched(function_of({0, 1, 2, 3, 4}), {1, std::nextafter(1, 2)});
        },
        {"range from 1 to 1.0000000000000002: is too narrow for the 5 points"});
}

}  // namespace
}  // namespace lamina
