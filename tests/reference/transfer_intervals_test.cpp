// SPDX-License-Identifier: Apache-2.0
#include "reference/transfer_intervals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "fixtures.h"

namespace lamina {
namespace {

void expect_found(const std::vector<double>& knots) {
    std::vector<TransferKnot> given;
    for (std::size_t i = 0; i < knots.size(); ++i)  // none on a line with its neighbours
        given.push_back({knots[i], {{1, 1, 1}, 1 + static_cast<double>(i * i % 5)}});
    const TransferIntervals intervals(TransferFunction::linear(given));
    std::vector<double> values{-INFINITY, INFINITY, -1e300, 1e300, 0};
    for (const double knot : knots)
        for (const double value : {knot, std::nextafter(knot, -INFINITY),
                                   std::nextafter(knot, INFINITY), knot - .01, knot + .01})
            values.push_back(value);
    for (const double value : values) {
        const auto above = std::ranges::upper_bound(knots, value) - knots.begin();
        const auto below = std::ranges::lower_bound(knots, value) - knots.begin();
        EXPECT_EQ(std::ssize(knots), static_cast<std::ptrdiff_t>(intervals.knot_count()));
        EXPECT_EQ(static_cast<std::ptrdiff_t>(intervals.above(value)), above) << value;
        EXPECT_EQ(static_cast<std::ptrdiff_t>(intervals.below(value)), below) << value;
    }
}

// The intervals that a search by bins finds are those of a search among all knots.
TEST(TransferIntervals, OfAValueAreFound) {
    expect_found({3});
    expect_found({0, 1});
    expect_found({-5, 2, 2, 7, 7, 9});
    expect_found({1e15, 1e15 + 1, 1e15 + 2, 1e15 + 9});
    expect_found({-1e-300, 0, 1e-300});
    expect_found({0, 1e-310});
    std::vector<double> crowded{-1000};
    for (int i = 0; i < 40; ++i) crowded.push_back(.001 * i);
    crowded.push_back(1000);
    expect_found(crowded);
    reference_test::Random random(9);
    std::vector<double> any;
    for (int i = 0; i < 300; ++i) any.push_back(random.uniform(-1, 1));
    std::ranges::sort(any);
    expect_found(any);
}

}  // namespace
}  // namespace lamina
