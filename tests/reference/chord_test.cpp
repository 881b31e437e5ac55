// SPDX-License-Identifier: Apache-2.0
#include "reference/chord.h"

#include <gtest/gtest.h>

#include "fixtures.h"

namespace lamina {
namespace {

using namespace reference_test;

constexpr double relative_tolerance =
    1e-14;  // the header promises 1e-15; world_length multiplies by a rounded norm

void expect_relative(double found, double expected) {
    EXPECT_LE(std::abs(found - expected), relative_tolerance * std::abs(expected))
        << found << " instead of " << expected;
}

TEST(Chord, AxisAlignedRaysCrossTheWholeBox) {
    const Grid node = make_grid({5, 4, 3}, Centering::node, {0.5, 2, 3});
    const Grid cell = make_grid({5, 4, 3}, Centering::cell, {0.5, 2, 3});
    const View::Ray along_x{{-7, 1, 1}, {1, 0, 0}};
    EXPECT_EQ(clip_to_box(node, along_x).world_length(), 2.0);  // (5 - 1) * 0.5
    EXPECT_EQ(clip_to_box(cell, along_x).world_length(), 2.5);  // 5 * 0.5
    const View::Ray along_z{{1, 1, 20}, {0, 0, -2}};
    EXPECT_EQ(clip_to_box(node, along_z).world_length(), 6.0);  // (3 - 1) * 3
    EXPECT_EQ(clip_to_box(node, along_z).length_z, 3.0);        // |direction| is 2
    EXPECT_EQ(clip_to_box(cell, along_z).world_length(), 9.0);  // 3 * 3
}

TEST(Chord, AxisWithOneSampleIsOneVoxelThick) {
    const Grid grid = make_grid({4, 4, 1}, Centering::node, {1, 1, 0.25});
    EXPECT_EQ(clip_to_box(grid, {{1, 1, 5}, {0, 0, -1}}).world_length(), 0.25);
}

TEST(Chord, EyeInsideOnAFaceAndBeyondTheBox) {
    const Grid grid = make_grid({3, 3, 3}, Centering::node);
    EXPECT_EQ(clip_to_box(grid, {{0.75, 1, 1}, {1, 0, 0}}).world_length(), 1.25);
    EXPECT_EQ(clip_to_box(grid, {{0, 1, 1}, {1, 0, 0}}).world_length(), 2.0);
    EXPECT_EQ(clip_to_box(grid, {{0, 1, 1}, {-1, 0, 0}}).world_length(), 0.0);
    EXPECT_EQ(clip_to_box(grid, {{3, 1, 1}, {1, 0, 0}}).world_length(), 0.0);
    EXPECT_EQ(clip_to_box(grid, {{3, 1, 1}, {-1, 0, 0}}).world_length(), 2.0);
}

TEST(Chord, BoxIsClosed) {
    const Grid grid = make_grid({3, 3, 3}, Centering::node);
    for (const double face : {0.0, 2.0}) {
        EXPECT_EQ(clip_to_box(grid, {{-1, face, 1}, {1, 0, 0}}).world_length(), 2.0) << "in a face";
        EXPECT_EQ(clip_to_box(grid, {{-1, face, face}, {1, 0, 0}}).world_length(), 2.0) << "edge";
        const double outside = std::nextafter(face, face > 1 ? 3 : -1);
        EXPECT_EQ(clip_to_box(grid, {{-1, outside, 1}, {1, 0, 0}}).world_length(), 0.0);
    }
    EXPECT_EQ(clip_to_box(grid, {{-1, 1, 1}, {1, -1, 0}}).world_length(), 0.0) << "only a corner";
}

// A ray that cuts off a corner of the box at a distance: through (2 - e, 2) and out at x = 2, so
// that length_z is e. All numbers are dyadic, hence exact; the plain (plane - origin) / direction
// would lose 1e-16 * distance / e.
TEST(Chord, SliversSeenFromAfarKeepAllDigits) {
    const Grid grid = make_grid({3, 3, 3}, Centering::node);
    for (const double distance : {4.0, 1024.0, 1048576.0}) {
        for (int bits = 4; bits <= 24; bits += 5) {
            for (const double slope : {1 / 64.0, 0.34375, 1.0, 2.53125}) {
                const double e = std::ldexp(1.0, -bits);
                const View::Ray ray{{2 - e - distance, 2 + slope * distance, 1}, {1, -slope, 0}};
                ASSERT_EQ((ray.origin.x + distance) + e, 2.0);  // the inputs are exact
                expect_relative(clip_to_box(grid, ray).length_z, e);
            }
        }
    }
}

TEST(Chord, EntryIsOnTheBox) {
    const Grid grid = make_grid({9, 7, 5}, Centering::cell, {0.1, 0.3, 0.7});
    Random random(7);
    for (int i = 0; i < 2000; ++i) {
        const glm::dvec3 eye = 100.0 * (random.point() - 0.5);
        const glm::dvec3 target = grid.to_world(random.point(0, 4));
        const Chord chord = clip_to_box(grid, {eye, target - eye});
        if (chord.length_z == 0) continue;
        int on_faces = 0;
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_GE(chord.entry[axis], grid.index_min()[axis]);
            EXPECT_LE(chord.entry[axis], grid.index_max()[axis]);
            on_faces += chord.entry[axis] == grid.index_min()[axis] ||
                        chord.entry[axis] == grid.index_max()[axis];
        }
        EXPECT_GE(on_faces, 1);
    }
}

// Through the middle of a rotated box, along a direction with components a, b, c in the box's own
// axes, the chord is min(size / |component|). The rotation (1, 2, 2; 2, 1, -2; 2, -2, 1) / 3 is
// exact but for the factor 1/3 in the steps.
TEST(Chord, RotatedBoxThroughItsMiddle) {
    Grid grid;
    grid.size = {17, 9, 5};
    grid.centering = {Centering::node, Centering::cell, Centering::node};
    const glm::dvec3 axes[3] = {{1, 2, 2}, {2, 1, -2}, {2, -2, 1}};
    const glm::dvec3 spacing{0.5, 0.25, 2};
    for (int axis = 0; axis < 3; ++axis)
        grid.step[axis] = spacing[axis] * axes[axis];  // length 3 s
    const glm::dvec3 extent = 3.0 * spacing * (grid.index_max() - grid.index_min());
    Random random(3);
    for (int i = 0; i < 500; ++i) {
        const glm::dvec3 local = random.point(-1, 1);
        const glm::dvec3 direction = local.x * axes[0] + local.y * axes[1] + local.z * axes[2];
        const View::Ray ray{middle_of(grid) - 64.0 * direction, direction};
        double expected = std::numeric_limits<double>::infinity();
        for (int axis = 0; axis < 3; ++axis) {
            expected = std::min(expected, extent[axis] / (3 * std::abs(local[axis])));
        }
        // The ray itself was rounded when it was made: relative to its length of 64, not to the
        // chord.
        EXPECT_NEAR(clip_to_box(grid, ray).length_z, expected,
                    64 * 8 * 2.3e-16 / glm::length(local));
    }
}

TEST(Chord, ViewAndRayAgree) {
    const Grid grid = make_grid({4, 4, 4}, Centering::node);
    const Camera camera = camera_at(grid, Projection::perspective, {1, 2, 3}, 1.2);
    const View view(camera, 20, 10);
    for (const double column : {0.0, 9.25, 10.0}) {
        const Chord chord = clip_to_box(grid, view.ray(column, 4.5));
        EXPECT_EQ(chord_length(grid, view, column, 4.5), chord.world_length());
    }
    EXPECT_GT(chord_length(grid, view, 9.5, 4.5), 1.0);
}

}  // namespace
}  // namespace lamina
