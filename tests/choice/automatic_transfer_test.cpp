// SPDX-License-Identifier: Apache-2.0
#include "choice/automatic_transfer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/common.hpp>

namespace lamina {
namespace {

// A distribution of which half is 0; the density of the other half falls from value 1 to 200.
ValueDistribution scan() {
    std::vector<WeightedValue> values{{0, 20100}};
    for (int value = 1; value <= 200; ++value)
        values.push_back({static_cast<double>(value), 201. - value});
    return ValueDistribution(values);
}

double largest(const TransferFunction& function) {
    double most = 0;
    for (const TransferKnot& knot : function.knots()) most = std::max(most, knot.optics.extinction);
    return most;
}

// Without a field, slopes are unknown. The outermost values are the densest; inside of a peak
// extinction may be less than at its top.
TEST(AutomaticTransfer, BackgroundIsTransparentAndTheRarestIsTheDensest) {
    const AutomaticTransfer chosen = choose_transfer_function(scan(), true);
    const TransferFunction& function = chosen.transfer_function;
    EXPECT_EQ(function.at(0).extinction, 0);
    EXPECT_TRUE(chosen.per_world_unit);
    EXPECT_EQ(function.at(200).extinction, largest(function));
    EXPECT_GT(function.at(200).extinction, 5 * function.at(20).extinction);
    EXPECT_NE(chosen.reason.find("transparent"), std::string::npos) << chosen.reason;
}

TEST(AutomaticTransfer, NoColorChannelIsFullyBright) {
    for (const bool whole : {true, false}) {
        const auto chosen = choose_transfer_function(scan(), whole);
        for (const TransferKnot& knot : chosen.transfer_function.knots()) {
            for (int c = 0; c < 3; ++c)
                // Linear light of the sRGB value 254.5 / 255.
                EXPECT_LT(knot.optics.color[c], .9956);
        }
    }
}

ValueDistribution labels_up_to(int last) {
    std::vector<WeightedValue> values;
    for (int label = 0; label <= last; ++label)
        values.push_back({static_cast<double>(label), label == 1 ? 1000. : 10.});
    return ValueDistribution(values);
}

// A sixteenth of full scale in one channel is a step that everybody sees.
TEST(AutomaticTransfer, GivesEachLabelAColourThatDiffersFromItsNeighbours) {
    const VolumeLabels nothing;
    const TransferFunction palette =
        choose_transfer_function(labels_up_to(3000), true, {}, least_padding, &nothing)
            .transfer_function;
    EXPECT_EQ(palette.at(0).extinction, 0);  // label 0 is the background, not the commonest
    for (int label = 1; label <= 3000; ++label) {
        EXPECT_GT(palette.at(label).extinction, .09) << label;  // at most ten times less dense
        EXPECT_EQ(palette.at(label), palette.at(label + .4)) << label;
        for (int back = 1; back <= 5 && back < label; ++back) {
            const glm::dvec3 change =
                glm::abs(palette.at(label).color - palette.at(label - back).color);
            EXPECT_GT(std::max({change.r, change.g, change.b}), 1. / 16) << label << " " << back;
        }
    }
}

TEST(AutomaticTransfer, TakesColoursOfLabelsFromTheirFile) {
    const VolumeLabels labels{true, {{0, "-5"}, {1, "0"}, {2, "8", "", glm::dvec3(.1, .2, .3)}}};
    const AutomaticTransfer chosen =
        choose_transfer_function(labels_up_to(2), true, {}, least_padding, &labels);
    EXPECT_EQ(chosen.transfer_function.at(1).extinction, 0);
    EXPECT_GT(chosen.transfer_function.at(0).extinction, 0);
    EXPECT_EQ(chosen.transfer_function.at(2).color, glm::dvec3(.1, .2, .3));
    EXPECT_NE(chosen.reason.find("labels: 0, "), std::string::npos) << chosen.reason;
}

TEST(AutomaticTransfer, TakesOpacitiesOfLabelsFromTheirFile) {
    VolumeLabels labels{false, {{1, "1", "", glm::dvec3(1)}, {2, "2"}}};
    labels.list[0].opacity = 0;
    labels.list[1].opacity = .5;
    const ValueDistribution values({{0, 70}, {1, 10}, {2, 10}, {3, 10}});
    const auto function =
        choose_transfer_function(values, true, {}, least_padding, &labels).transfer_function;
    EXPECT_EQ(function.at(1).extinction, 0);
    EXPECT_EQ(function.at(2).extinction, .5);
    EXPECT_EQ(function.at(3).extinction, 1);
}

// A range has the file's numbers, whatever codes stand for them.
TEST(AutomaticTransfer, OfLabelsShowsTheNumbersInARange) {
    const VolumeLabels labels{true,
                              {{0, "0"}, {1, "9"}, {2, "5000000000"}, {3, "9007199254740993"}}};
    const ValueDistribution values({{0, 70}, {1, 10}, {2, 10}, {3, 10}});
    TransferAdjustments adjustments;
    adjustments.range = ValueRange{8, 5e9};
    const AutomaticTransfer chosen =
        choose_transfer_function(values, true, adjustments, least_padding, &labels);
    const bool shown[] = {false, true, true, false};
    for (int code = 0; code < 4; ++code)
        EXPECT_EQ(chosen.transfer_function.at(code).extinction > 0, shown[code]) << code;
    EXPECT_NE(chosen.reason.find("labels from 8 to 5000000000 show"), std::string::npos)
        << chosen.reason;
    // 2^53 + 1, which no double is.
    adjustments.range = ValueRange{5e9, 0x1p53};
    EXPECT_EQ(choose_transfer_function(values, true, adjustments, least_padding, &labels)
                  .transfer_function.at(3)
                  .extinction,
              0);
}

TEST(AutomaticTransfer, OfOneLabelShowsItUnlessItIsTheBackground) {
    const VolumeLabels nothing;
    const auto chosen = [&](double label) {
        return choose_transfer_function(ValueDistribution({{label, 10}}), true, {}, least_padding,
                                        &nothing);
    };
    EXPECT_EQ(chosen(0).transfer_function.at(0).extinction, 0);
    EXPECT_EQ(chosen(0).reason,
              "1 label: 0, 100 % of the field, is transparent, so that nothing shows");
    EXPECT_EQ(chosen(7).transfer_function.at(7).extinction, 1);
    EXPECT_EQ(chosen(-1).transfer_function.at(-1).extinction, 0);
}

TEST(AutomaticTransfer, BothSidesOfACommonValueShow) {
    std::vector<WeightedValue> values{{0, 1000}};
    for (int i = 1; i <= 100; ++i) {
        values.push_back({-1. * i, 3});
        values.push_back({1. * i, 3});
    }
    const auto function =
        choose_transfer_function(ValueDistribution(values), true).transfer_function;
    EXPECT_EQ(function.at(0).extinction, 0);
    EXPECT_GT(function.at(-90).extinction, .1);
    EXPECT_GT(function.at(90).extinction, .1);
    EXPECT_GT(function.at(-50).color.b, function.at(-50).color.r);  // cool below, warm above
    EXPECT_GT(function.at(50).color.r, function.at(50).color.b);
}

TEST(AutomaticTransfer, FewWholeNumbersAreLabels) {
    const ValueDistribution values({{0, 70}, {1, 10}, {2, 10}, {7, 10}});
    const auto function = choose_transfer_function(values, true).transfer_function;
    EXPECT_EQ(function.at(0).extinction, 0);
    EXPECT_EQ(function.at(1), function.at(1.4));  // a label has one colour
    EXPECT_EQ(function.at(2), function.at(4.4));  // up to the middle between 2 and 7
    EXPECT_NE(function.at(1).color, function.at(2).color);
    EXPECT_NE(function.at(2).color, function.at(7).color);
    // If the values are not known to be whole numbers, the same numbers are not labels.
    EXPECT_NE(choose_transfer_function(values, false).transfer_function, function);
}

TEST(AutomaticTransfer, DataOfOneValueAreVisibleEverywhere) {
    const auto function =
        choose_transfer_function(ValueDistribution({{5, 1}}), false).transfer_function;
    EXPECT_EQ(function.max_extinction(-1e9, 1e9), 1);
    EXPECT_TRUE(function.constant(-1e9, 1e9));
    EXPECT_EQ(choose_transfer_function(ValueDistribution(), false).transfer_function.knots().size(),
              1u);  // no value at all
}

TEST(AutomaticTransfer, ShowsTheGivenRange) {
    const auto function =
        choose_transfer_function(scan(), true, {.range = ValueRange{50, 150}}).transfer_function;
    EXPECT_EQ(function.knots().front().value, 50);
    EXPECT_EQ(function.knots().back().value, 150);
    EXPECT_EQ(function.at(50).extinction, 0);
    EXPECT_EQ(function.at(200), function.at(150));
    EXPECT_EQ(function.at(200).extinction, largest(function));
    const auto empty = choose_transfer_function(scan(), true, {.range = ValueRange{300, 400}});
    // A ramp, because the range has no values.
    EXPECT_EQ(empty.transfer_function.at(400).extinction, 1);
}

TEST(AutomaticTransfer, TakesTheColorsOfAMap) {
    const Colormap grey{{{0, {0, 0, 0}}, {1, {.5, .5, .5}}}, {}, false};
    const auto plain = choose_transfer_function(scan(), true).transfer_function;
    const auto function =
        choose_transfer_function(scan(), true, {.colormap = grey}).transfer_function;
    const double lo = plain.knots().front().value, hi = plain.knots().back().value;
    EXPECT_EQ(function.at(lo).color, glm::dvec3(0));
    EXPECT_EQ(function.at(hi).color, glm::dvec3(.5));
    for (const TransferKnot& knot : plain.knots())
        EXPECT_NEAR(function.at(knot.value).extinction, knot.optics.extinction,
                    1e-12);  // roundings
}

}  // namespace
}  // namespace lamina
