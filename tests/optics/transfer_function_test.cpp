// SPDX-License-Identifier: Apache-2.0
#include "lamina/transfer_function.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "base/error.h"

namespace lamina {
namespace {

TransferKnot knot(double value, double extinction, glm::dvec3 color = glm::dvec3(0.5)) {
    return {value, {color, extinction}};
}

std::string message_of(const std::vector<TransferKnot>& points) {
    try {
        TransferFunction::linear(points);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

TEST(TransferFunction, IsLinearBetweenKnotsAndConstantOutside) {
    const auto f = TransferFunction::linear(
        {knot(10, 1, glm::dvec3(0, 1, 0.5)), knot(20, 3, glm::dvec3(1, 0, 0.5))});
    EXPECT_EQ(f.at(-1e9).extinction, 1);
    EXPECT_EQ(f.at(10).extinction, 1);
    EXPECT_EQ(f.at(15).extinction, 2);
    EXPECT_EQ(f.at(17.5).color, glm::dvec3(0.75, 0.25, 0.5));
    EXPECT_EQ(f.at(20).extinction, 3);
    EXPECT_EQ(f.at(1e9).extinction, 3);
}

TEST(TransferFunction, LaterKnotCountsAtAStep) {
    const auto f = TransferFunction::linear({knot(0, 1), knot(5, 2), knot(5, 7), knot(10, 8)});
    EXPECT_EQ(f.at(5).extinction, 7);
    EXPECT_NEAR(f.at(std::nextafter(5, 0)).extinction, 2, 1e-14);
    const auto at_ends = TransferFunction::linear({knot(0, 1), knot(0, 2), knot(1, 3), knot(1, 4)});
    EXPECT_EQ(at_ends.at(-1).extinction, 1);
    EXPECT_EQ(at_ends.at(0).extinction, 2);
    EXPECT_EQ(at_ends.at(1).extinction, 4);
}

TEST(TransferFunction, NearestStepsHalfwayBetweenPoints) {
    const auto f = TransferFunction::nearest({knot(0, 1), knot(10, 2), knot(14, 3)});
    for (const auto& [value, extinction] :
         {std::pair{-9., 1.}, {4.99, 1.}, {5., 2.}, {11.99, 2.}, {12., 3.}, {99., 3.}}) {
        EXPECT_EQ(f.at(value).extinction, extinction) << value;
    }
    EXPECT_EQ(f.knots().size(), 4u);
    EXPECT_EQ(TransferFunction::nearest({knot(3, 2)}).at(7).extinction, 2);
}

TEST(TransferFunction, NearestOfNeighboringDoublesHasAtMostTwoKnotsAtAValue) {
    std::vector<TransferKnot> points;
    double value = 1;
    for (int i = 0; i < 9; ++i, value = std::nextafter(value, 2)) points.push_back(knot(value, i));
    const auto f = TransferFunction::nearest(points);
    for (std::size_t i = 2; i < f.knots().size(); ++i) {
        EXPECT_GT(f.knots()[i].value, f.knots()[i - 2].value);
    }
    EXPECT_EQ(f.at(0).extinction, 0);
    EXPECT_EQ(f.at(2).extinction, 8);
}

// A point is left out if colour and extinction both are on the line, to a few roundings of their
// own value, so that nothing faint is lost. Steps keep their height.
TEST(TransferFunction, PointsOnTheLineBetweenTheirNeighborsAreLeftOut) {
    const auto count = [](const std::vector<TransferKnot>& points) {
        return TransferFunction::linear(points).knots().size();
    };
    const glm::dvec3 grey(.3), red(.3, 0, 0);
    EXPECT_EQ(count({knot(0, 0, grey), knot(.1, .1, grey), knot(.7, .7, grey), knot(1, 1, grey)}),
              2u);
    EXPECT_EQ(count({knot(0, 2, grey), knot(3, 2, grey), knot(3, 2, grey), knot(9, 2, grey)}), 2u);
    EXPECT_EQ(count({knot(0, 0, grey), knot(.5, .5, red), knot(1, 1, grey)}), 3u);
    EXPECT_EQ(count({knot(0, 0, grey), knot(.5, .5 + 1e-14, grey), knot(1, 1, grey)}), 3u);
    EXPECT_EQ(count({knot(0, 0, grey), knot(.5, 1e-300, grey), knot(1, 0, grey)}), 3u);
    EXPECT_EQ(count({knot(0, 0, grey), knot(.5, .5, grey), knot(.5, .7, grey), knot(1, 1, grey)}),
              4u);
    const std::vector<TransferKnot> labels{knot(0, 0, grey), knot(1, 0, grey), knot(2, 1, red),
                                           knot(3, 1, red), knot(4, 0, grey)};
    EXPECT_EQ(TransferFunction::nearest(labels).knots().size(), 5u);  // its begin, two steps
}

TEST(TransferFunction, NamesTheBadPoint) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(message_of({}), "no points, expected at least one");
    EXPECT_EQ(message_of({knot(0, 0), knot(1, 0), knot(2, 0), knot(3, -1)}),
              "point 3: extinction is -1, expected a finite number >= 0");
    EXPECT_EQ(message_of({knot(0, nan)}),
              "point 0: extinction is nan, expected a finite number >= 0");
    EXPECT_EQ(message_of({knot(0, 1, glm::dvec3(0, -2, 0))}),
              "point 0: green is -2, expected a finite number >= 0");
    EXPECT_EQ(message_of({knot(5, 1), knot(4, 1)}),
              "point 1: value is 4, expected at least 5, the value of the point before it");
    EXPECT_EQ(message_of({knot(5, 1), knot(5, 1), knot(5, 1)}),
              "point 2: value is 5 for the third time, expected at most two points at a value");
    EXPECT_EQ(message_of({knot(0, 1), knot(nan, 1)}),
              "point 1: value is nan, expected a number between -1e300 and 1e300");
}

TEST(TransferFunction, BothSidesOfAStepCountInAClosedInterval) {
    const auto f = TransferFunction::linear(
        {knot(0, 0), knot(5, 0), knot(5, 9), knot(6, 9), knot(6, 0), knot(10, 4)});
    EXPECT_EQ(f.max_extinction(0, 4.9), 0);
    EXPECT_EQ(f.max_extinction(0, 5), 9);
    EXPECT_EQ(f.max_extinction(6, 8), 9);  // the left side of the step at 6
    EXPECT_EQ(f.max_extinction(7, 8), 2);
    EXPECT_EQ(f.max_extinction(20, 30), 4);
    EXPECT_TRUE(f.transparent(-3, 4));
    EXPECT_FALSE(f.transparent(-3, 5));
    EXPECT_TRUE(f.constant_extinction(5.5, 5.9));
    EXPECT_FALSE(f.constant_extinction(5.5, 6));
}

TEST(TransferFunction, ConstantAndSingleColorLookOnlyAtTheInterval) {
    const glm::dvec3 red(1, 0, 0), blue(0, 0, 1);
    const auto f = TransferFunction::linear({knot(0, 0, blue), knot(1, 0, red), knot(2, 3, red),
                                             knot(3, 3, red), knot(4, 0, blue), knot(9, 0, red)});
    EXPECT_TRUE(f.single_color(0, 3));  // blue is there, but transparent
    EXPECT_FALSE(f.single_color(0, 3.1));
    EXPECT_TRUE(f.single_color(4, 9));
    EXPECT_FALSE(f.constant(0, 1));
    EXPECT_TRUE(f.constant(2, 3));
    EXPECT_FALSE(f.constant(2, 3.5));
    EXPECT_TRUE(f.constant(3.5, 3.5));
    EXPECT_TRUE(f.constant(-7, 0));
    EXPECT_TRUE(f.constant_extinction(0, 1));
    EXPECT_FALSE(f.constant_extinction(0, 1.5));
}

// Labels make functions of so many knots that they are searched by blocks.
TEST(TransferFunction, FindsTheLargestOfManyExtinctions) {
    constexpr int count = 1500;
    std::vector<TransferKnot> points;
    for (int i = 0; i < count; ++i) points.push_back(knot(i, (7919 * i) % 1499));
    const auto f = TransferFunction::nearest(points);
    const auto thin = f.attenuated(.5);
    for (int lo = 0; lo < count; lo += 37) {
        double largest = 0;
        for (int hi = lo; hi < count; ++hi) {
            largest = std::max(largest, points[static_cast<std::size_t>(hi)].optics.extinction);
            ASSERT_EQ(f.max_extinction(lo, hi), largest) << lo << " " << hi;
            ASSERT_EQ(thin.max_extinction(lo, hi), .5 * largest) << lo << " " << hi;
        }
        EXPECT_TRUE(f.constant(lo - .4, lo + .4)) << lo;
        EXPECT_FALSE(f.constant(lo - .4, lo + 1)) << lo;
    }
}

}  // namespace
}  // namespace lamina
