// SPDX-License-Identifier: Apache-2.0
#include "reference/chord.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "base/arithmetic.h"
#include "fixtures.h"
#include "support/each_instruction_set.h"

namespace lamina {
namespace {

using namespace reference_test;

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double relative_tolerance =
    1e-14;  // chord.h promises 1e-15; world_length() multiplies by a rounded norm

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

TEST(Chord, StartsAtAnEyeInsideOrOnAFace) {
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

// A ray that cuts off a corner of the box, seen from `distance`: it passes (2 - e, 2) and leaves at
// x = 2, so that length_z is e. All numbers are dyadic, hence exact. Plain (plane - origin) /
// direction would have a relative error of 1e-16 * distance / e.
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

// A chord through the middle of a rotated box, along a direction with components a, b, c in the
// box's own axes, is min(size / |component|) long. The rotation (1, 2, 2; 2, 1, -2; 2, -2, 1) / 3
// is exact but for the factor 1/3 in the steps.
TEST(Chord, IsExactThroughTheMiddleOfARotatedBox) {
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
        // The ray itself is rounded relative to its length of 64, not to the chord's.
        EXPECT_NEAR(clip_to_box(grid, ray).length_z, expected,
                    64 * 8 * 2.3e-16 / glm::length(local));
    }
}

TEST(Chord, HasTheSameLengthForViewAndRay) {
    const Grid grid = make_grid({4, 4, 4}, Centering::node);
    const Camera camera = camera_at(grid, Projection::perspective, {1, 2, 3}, 1.2);
    const View view(camera, 20, 10);
    for (const double column : {0.0, 9.25, 10.0}) {
        const Chord chord = clip_to_box(grid, view.ray(column, 4.5));
        EXPECT_EQ(chord_length(grid, view, column, 4.5), chord.world_length());
    }
    EXPECT_GT(chord_length(grid, view, 9.5, 4.5), 1.0);
}

// Clips a ray to a box along the world's axes, in plain steps.
Chord clip_simply(const Grid& grid, const View::Ray& ray) {
    const glm::dvec3 lowest = grid.index_min(), highest = grid.index_max();
    DoubleDouble position[3], slope[3], from, to{INFINITY, 0};
    int entry_axis = -1;
    for (int i = 0; i < 3; ++i) {
        const DoubleDouble step{grid.step[static_cast<std::size_t>(i)][i], 0};
        position[i] = exact_sum(ray.origin[i], -grid.origin[i]) / step;
        slope[i] = DoubleDouble{ray.direction[i], 0} / step;
        if (slope[i].hi == 0) {
            if (position[i].hi < lowest[i] || position[i].hi > highest[i]) return {};
            continue;
        }
        DoubleDouble near = (DoubleDouble{lowest[i], 0} - position[i]) / slope[i];
        DoubleDouble far = (DoubleDouble{highest[i], 0} - position[i]) / slope[i];
        if (far < near) std::swap(near, far);
        if (from < near) from = near, entry_axis = i;
        if (far < to) to = far;
    }
    if (!(from < to)) return {};
    Chord chord;
    chord.length_z = (to - from).rounded();
    chord.world_per_z = glm::length(ray.direction);
    for (int i = 0; i < 3; ++i) {
        chord.direction[i] = slope[i].rounded();
        chord.entry[i] =
            std::clamp((position[i] + slope[i] * from).rounded(), lowest[i], highest[i]);
    }
    if (entry_axis >= 0)
        chord.entry[entry_axis] =
            chord.direction[entry_axis] > 0 ? lowest[entry_axis] : highest[entry_axis];
    return chord;
}

// Clips many rays together in each instruction set, and expects the chords of single rays, bit for
// bit: through the box and beside it, along its axes, and cut by half-spaces.
TEST(Chord, IsTheSameForManyRaysTogetherAndAlone) {
    Random random(5);
    Grid grid = make_grid({7, 5, 9}, Centering::cell, {.3, 1.7, .9});
    grid.origin = {.1, -3, 17};
    const Camera camera = camera_at(grid, Projection::perspective, {1, .3, .2}, .8);
    const std::vector<HalfSpace> clip{{middle_of(grid), {1, .4, -.2}}};
    std::vector<View::Ray> rays;
    for (int i = 0; i < 403; ++i) {
        View::Ray ray{camera.eye + .2 * random.point(-1, 1), random.point(-1, 1)};
        if (i % 3 > 0) ray.direction += glm::dvec3(-1.5, -.4, -.3);
        if (i % 5 == 0) ray.direction[i % 3] = 0;
        if (i % 7 == 0) {
            const int axis = i / 7 % 3;
            ray = {middle_of(grid) + random.point(-1, 1), glm::dvec3(0)};
            ray.direction[axis] = i % 2 == 0 ? 1 : -1e-300;
        }
        rays.push_back(ray);
    }
    const auto bits = [](const Chord& chord) {
        return std::array{chord.entry.x,     chord.entry.y,     chord.entry.z,  chord.direction.x,
                          chord.direction.y, chord.direction.z, chord.length_z, chord.world_per_z};
    };
    const std::span<const HalfSpace> whole;
    for (const std::span<const HalfSpace>& cut : {whole, std::span<const HalfSpace>(clip)}) {
        std::vector<Chord> alone;
        std::size_t met = 0;
        for (const View::Ray& ray : rays) {
            alone.push_back(clip_to_box(grid, ray, cut));
            met += alone.back().length_z > 0 ? 1 : 0;
        }
        EXPECT_GT(met, 100U);
        EXPECT_LT(met, 350U);
        test::for_each_instruction_set([&](const std::string& name) {
            std::vector<Chord> together(rays.size());
            clip_to_box(GridAxes(grid), rays, cut, together);
            for (std::size_t i = 0; i < rays.size(); ++i)
                ASSERT_EQ(bits(together[i]), bits(alone[i])) << name << ", ray " << i;
            if (!cut.empty()) return;
            for (std::size_t i = 0; i < rays.size(); ++i) {
                const auto expected = bits(clip_simply(grid, rays[i])), found = bits(together[i]);
                // Both numbers are rounded once from numbers of some 30 digits.
                for (std::size_t k = 0; k < found.size(); ++k)
                    ASSERT_NEAR(found[k], expected[k], epsilon * std::abs(expected[k]))
                        << name << ", ray " << i;
            }
        });
    }
}

}  // namespace
}  // namespace lamina
