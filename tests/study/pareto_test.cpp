// SPDX-License-Identifier: Apache-2.0
#include "study/study_results.h"

#include <gtest/gtest.h>

#include <random>

namespace lamina::study {
namespace {

// Returns the front by its definition: no other point is as good in both numbers and better in one.
std::vector<bool> front_by_definition(const std::vector<CostAndError>& points) {
    std::vector<bool> front;
    for (const CostAndError& a : points) {
        bool beaten = false;
        for (const CostAndError& b : points) {
            beaten |=
                b.cost <= a.cost && b.error <= a.error && (b.cost < a.cost || b.error < a.error);
        }
        front.push_back(!beaten);
    }
    return front;
}

TEST(Pareto, FrontMatchesItsDefinition) {
    std::mt19937 random(7);
    for (int trial = 0; trial < 2000; ++trial) {
        // With few values, many points are equal in one number or in both.
        const int values = 1 + trial % 9;
        std::uniform_int_distribution<int> value(0, values);
        std::vector<CostAndError> points(static_cast<std::size_t>(trial % 24));
        for (CostAndError& point : points) point = {0.5 * value(random), 0.25 * value(random)};
        EXPECT_EQ(pareto_front(points), front_by_definition(points)) << trial;
    }
}

TEST(Pareto, FrontWithoutTiesMatchesItsDefinition) {
    std::mt19937 random(8);
    std::uniform_real_distribution<double> value(0, 1);
    std::vector<CostAndError> points(500);
    for (CostAndError& point : points) point = {value(random), value(random)};
    EXPECT_EQ(pareto_front(points), front_by_definition(points));
}

TEST(Pareto, EqualPointsAreAllOnTheFront) {
    EXPECT_EQ(pareto_front({{1, 1}, {1, 1}, {2, 1}, {1, 2}, {0, 3}}),
              (std::vector<bool>{true, true, false, false, true}));
    EXPECT_TRUE(pareto_front({}).empty());
}

}  // namespace
}  // namespace lamina::study
