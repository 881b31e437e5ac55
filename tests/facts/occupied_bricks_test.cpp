// SPDX-License-Identifier: Apache-2.0
#include "facts/bricks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

namespace lamina {
namespace {

using Place = std::array<std::int64_t, 3>;

template <typename Visit>
void for_each_brick(const Place& count, const Visit& visit) {
    for (std::int64_t z = 0; z < count[2]; ++z)
        for (std::int64_t y = 0; y < count[1]; ++y)
            for (std::int64_t x = 0; x < count[0]; ++x) visit(Place{x, y, z});
}

OccupiedBricks with_shown(const Place& count, const std::vector<Place>& shown) {
    OccupiedBricks bricks;
    bricks.count = count;
    bricks.distance = SparseBytes(static_cast<std::size_t>(count[0] * count[1] * count[2]),
                                  OccupiedBricks::farthest);
    for (const Place& at : shown) {
        bricks.distance.set(static_cast<std::size_t>((at[2] * count[1] + at[1]) * count[0] + at[0]),
                            0);
    }
    bricks.measure_distances();
    return bricks;
}

std::vector<Place> some_of(const Place& count, int number, std::mt19937& random) {
    std::vector<Place> places;
    for (int i = 0; i < number; ++i) {
        Place at{};
        for (std::size_t axis = 0; axis < 3; ++axis)
            at[axis] = static_cast<std::int64_t>(random()) % count[axis];
        places.push_back(at);
    }
    return places;
}

std::int64_t distance_between(const Place& a, const Place& b) {
    return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

// Compares with the least distance over all visible bricks.
TEST(OccupiedBricks, DistancesAreThoseToTheNearest) {
    std::mt19937 random(1);
    for (const Place& count :
         {Place{13, 7, 9}, {1, 20, 3}, {5, 1, 1}, {1, 1, 1}, {600, 2, 1}, {3, 150, 140}}) {
        for (const int number : {1, 2, 5, 40}) {
            const std::vector<Place> shown = some_of(count, number, random);
            const OccupiedBricks bricks = with_shown(count, shown);
            for_each_brick(count, [&](const Place& at) {
                std::int64_t nearest = OccupiedBricks::farthest;
                for (const Place& other : shown)
                    nearest = std::min(nearest, distance_between(at, other));
                EXPECT_EQ(bricks.distance_at(at[0], at[1], at[2]), nearest);
            });
        }
    }
}

// Tests boxes of any size, also longer than the largest distance.
TEST(OccupiedBricks, AreFoundInBoxesOfAnySize) {
    std::mt19937 random(4);
    const Place count{200, 9, 90};
    for (int trial = 0; trial < 40; ++trial) {
        const std::vector<Place> shown = some_of(count, 1 + trial % 4, random);
        const OccupiedBricks bricks = with_shown(count, shown);
        for (int box = 0; box < 100; ++box) {
            Place first = some_of(count, 1, random)[0], last = some_of(count, 1, random)[0];
            for (std::size_t axis = 0; axis < 3 && box % 4 != 0; ++axis)
                if (first[axis] > last[axis]) std::swap(first[axis], last[axis]);
            const bool expected = std::ranges::any_of(shown, [&](const Place& at) {
                bool inside = true;
                for (std::size_t axis = 0; axis < 3; ++axis)
                    inside = inside && first[axis] <= at[axis] && at[axis] <= last[axis];
                return inside;
            });
            EXPECT_EQ(bricks.any_of(first, last), expected);
        }
    }
}

TEST(OccupiedBricks, AllBricksAreFarthestIfNoneIsOccupied) {
    const OccupiedBricks bricks = with_shown({3, 4, 5}, {});
    EXPECT_EQ(bricks.distance.count(OccupiedBricks::farthest), 60u);
    EXPECT_FALSE(bricks.any_in({-9, -9, -9}, {99, 99, 99}));
}

TEST(OccupiedBricks, TheEmptyBoxAroundAPointHoldsNone) {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> place(-3, 45);
    const Place count{11, 10, 9};
    for (int trial = 0; trial < 300; ++trial) {
        const std::vector<Place> shown = some_of(count, 3, random);
        const OccupiedBricks bricks = with_shown(count, shown);
        const glm::dvec3 point{place(random), place(random), place(random)};
        glm::dvec3 min, max;
        const bool empty = bricks.empty_around(point, min, max);
        EXPECT_EQ(empty, !bricks.any_in(point, point));
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_LE(min[axis], point[axis]);
            EXPECT_GE(max[axis], point[axis]);
        }
        const glm::dvec3 inside(1e-9);  // because neighbouring bricks share their borders
        EXPECT_EQ(bricks.any_in(min + inside, max - inside), !empty);
        if (!empty) continue;
        // With one more brick on each side, the box would hold a visible brick.
        EXPECT_TRUE(bricks.any_in(min - 4.0, max + 4.0));
    }
}

}  // namespace
}  // namespace lamina
