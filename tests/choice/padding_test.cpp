// SPDX-License-Identifier: Apache-2.0
#include "choice/value_distribution.h"

#include <gtest/gtest.h>

#include <cmath>

#include "choice/automatic_transfer.h"

namespace lamina {
namespace {

// Values as in a CT scan: a peak of air, and tissue above it.
std::vector<WeightedValue> ct_values() {
    std::vector<WeightedValue> values;
    for (int i = -1024; i <= 3000; i += 8) {
        values.push_back({1. * i, 50 * std::exp(-std::pow((i + 1000) / 15., 2)) +
                                      10 * std::exp(-std::pow((i - 40) / 60., 2)) + .02});
    }
    return values;
}

ValueDistribution with(std::vector<WeightedValue> values, double value, double weight) {
    values.push_back({value, weight});
    return ValueDistribution(values);
}

TEST(Padding, IsFarFromAllOtherValues) {
    for (const double value : {-2000., -3024., -9999., -32768., 32767., 1e20, 9.96921e36}) {
        const ValueDistribution all = with(ct_values(), value, 40);
        const Padding found = find_padding(all, true);
        ASSERT_EQ(found.values, std::vector{value}) << value;
        EXPECT_NEAR(found.share, all.share(value, value), 1e-15) << value;
        EXPECT_EQ(found.rest.lowest(), -1024);
        EXPECT_EQ(found.rest.highest(), 3000);
        EXPECT_EQ(found.below.has_value(), value < 0);
        EXPECT_EQ(found.above.has_value(), value > 0);
        const double edge = value < 0 ? found.edge_below() : found.edge_above();
        EXPECT_LT(value < 0 ? value : 3000, edge) << value;
        EXPECT_GT(value < 0 ? -1024 : value, edge) << value;
    }
}

TEST(Padding, MayLieBothBelowAndAboveTheData) {
    auto values = ct_values();
    values.push_back({-9999, 5});
    const Padding found = find_padding(with(values, 1e30, 5), false);
    EXPECT_EQ(found.values.size(), 2u);
    EXPECT_TRUE(found.below && found.above);
}

// With a least share of 0, as for meshes, where a single vertex may mark missing data, padding may
// be rare.
TEST(Padding, MayBeRareIfItIsFarAway) {
    for (const double value : {-9999., -32768., 32767., 1e20}) {
        const ValueDistribution all = with(ct_values(), value, 1e-6);
        EXPECT_TRUE(find_padding(all, false).values.empty()) << value;
        EXPECT_EQ(find_padding(all, false, 0).values, std::vector{value}) << value;
        EXPECT_EQ(find_markers(all), std::vector{value}) << value;
    }
    // Only a quarter of the range below the rest.
    const ValueDistribution near = with(ct_values(), -2000, 1e-6);
    EXPECT_TRUE(find_padding(near, false, 0).values.empty());
    EXPECT_TRUE(find_markers(ValueDistribution(ct_values())).empty());
    EXPECT_TRUE(find_markers(ValueDistribution()).empty());
}

TEST(Padding, DoesNotIncludeImplantsSpecksOrBackground) {
    const auto none = [](const ValueDistribution& all) {
        return find_padding(all, true).values.empty();
    };
    EXPECT_TRUE(none(ValueDistribution(ct_values())));
    EXPECT_TRUE(none(with(ct_values(), -3024, 1e-6)));  // a speck
    EXPECT_TRUE(none(with(ct_values(), 5000, 2)));      // an implant
    EXPECT_TRUE(none(with({{0, 5}, {1, 5}}, 10, 5)));
    EXPECT_TRUE(none(ValueDistribution({{0, 1}})));
    EXPECT_TRUE(none(ValueDistribution()));
    // A brain that was cut out of its surroundings: 0 is background, and no padding.
    std::vector<WeightedValue> brain{{0, 700}};
    for (int i = 0; i < 200; ++i) brain.push_back({900. + i, 1});
    EXPECT_TRUE(none(ValueDistribution(brain)));
}

// Cells that lie across the border of padding and data show nothing of the padding.
TEST(Padding, IsTransparent) {
    const ValueDistribution below = with(ct_values(), -3024, 40);
    const auto chosen = choose_transfer_function(below, true);
    const TransferFunction& function = chosen.transfer_function;
    EXPECT_TRUE(function.transparent(-3024, -990));  // the air, too
    EXPECT_GT(function.at(40).extinction, 0);
    EXPECT_EQ(chosen.padding.find("-3024, "), 0u) << chosen.padding;
    // A field with values on both sides of a common one, and padding below or above.
    std::vector<WeightedValue> flow;
    for (int i = -100; i <= 100; ++i) flow.push_back({1. * i, i == 0 ? 400. : 2.});
    for (const double value : {-9999., 9999.}) {
        const auto both = choose_transfer_function(with(flow, value, 100), false);
        EXPECT_GT(both.transfer_function.at(-100).extinction, 0) << value;
        EXPECT_GT(both.transfer_function.at(100).extinction, 0) << value;
        EXPECT_EQ(both.transfer_function.at(value).extinction, 0);
        EXPECT_EQ(both.transfer_function.at(.02 * value).extinction, 0);
    }
    // Values between nearer padding and the common value would show as a thick shell, so they are
    // transparent if the values on the other side show.
    const auto near = choose_transfer_function(with(flow, -999, 100), false).transfer_function;
    EXPECT_EQ(near.at(-50).extinction, 0);
    EXPECT_GT(near.at(50).extinction, 0);
    // In a wished range padding shows, too.
    const auto wished = choose_transfer_function(below, true, {.range = ValueRange{-4000, 3000}});
    EXPECT_GT(wished.transfer_function.at(-3000).extinction, 0);
    // Above a wished range values show like its end, except for padding.
    const auto part =
        choose_transfer_function(with(flow, 9999, 100), false, {.range = ValueRange{20, 60}});
    EXPECT_GT(part.transfer_function.at(100).extinction, 0);
    EXPECT_EQ(part.transfer_function.at(9999).extinction, 0);
    EXPECT_EQ(part.transfer_function.at(1000).extinction, 0);
    EXPECT_EQ(part.padding.find("9999, "), 0u) << part.padding;
}

}  // namespace
}  // namespace lamina
