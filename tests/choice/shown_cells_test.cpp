// SPDX-License-Identifier: Apache-2.0
#include "choice/shown_cells.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <random>
#include <set>
#include <vector>

#include "base/memory.h"
#include "choice/field.h"
#include "facts/volume_facts.h"
#include "support/stored_volume.h"
#include "support/volume_of.h"

namespace lamina {
namespace {

// Extent of points along a direction.
struct Spread {
    double lo = INFINITY, hi = -INFINITY;
    void add(double value) {
        lo = std::min(lo, value);
        hi = std::max(hi, value);
    }
};

Spread reach_of(const std::vector<glm::dvec3>& points, const glm::dvec3& along) {
    Spread reach;
    for (const glm::dvec3& point : points) reach.add(glm::dot(point, along));
    return reach;
}

bool shows(const ValueRange& range) {
    return range.hi > 100;
}

// Returns all corners of all cells with a sample above 100, found by testing every cell.
std::vector<glm::dvec3> all_shown_corners(const Volume& volume) {
    const Grid& grid = volume.grid();
    const auto* const samples = static_cast<const std::uint8_t*>(volume.data());
    std::vector<glm::dvec3> points;
    std::array<std::int64_t, 3> cells;
    for (std::size_t axis = 0; axis < 3; ++axis)
        cells[axis] = std::max<std::int64_t>(1, grid.size[axis] - 1);
    for (std::int64_t cell = 0; cell < cells[0] * cells[1] * cells[2]; ++cell) {
        const std::array<std::int64_t, 3> at{cell % cells[0], cell / cells[0] % cells[1],
                                             cell / cells[0] / cells[1]};
        bool any = false;
        std::array<glm::dvec3, 8> corners;
        for (std::size_t corner = 0; corner < 8; ++corner) {
            std::array<std::int64_t, 3> sample;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const std::int64_t side = std::int64_t(corner >> axis & 1);
                sample[axis] = std::min(at[axis] + side, grid.size[axis] - 1);
                const int a = static_cast<int>(axis);
                double plane = static_cast<double>(at[axis] + side);
                if (at[axis] + side == 0) plane = grid.index_min()[a];
                if (at[axis] + side == cells[axis]) plane = grid.index_max()[a];
                corners[corner][a] = plane;
            }
            any |= samples[(sample[2] * grid.size[1] + sample[1]) * grid.size[0] + sample[0]] > 100;
        }
        if (!any) continue;
        for (const glm::dvec3& corner : corners) points.push_back(grid.to_world(corner));
    }
    return points;
}

// Returns a volume with scattered samples above 100, so that visible cells of a row begin and end
// anywhere in a brick, also in the first and the last cell.
Volume lone_samples(std::array<std::int64_t, 3> size, Centering centering, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> share(0, 1);
    const double most = seed % 3 == 0 ? .3 : .01;
    return test::volume_of<std::uint8_t>(
        test::grid_of(size, centering),
        [&](double, double, double) { return share(random) < most ? 200. : 90.; });
}

TEST(ShownCells, HaveTheHullOfAnExhaustiveSearch) {
    std::mt19937 random(7);
    std::normal_distribution<double> normal;
    unsigned seed = 0;
    for (const Centering centering : {Centering::node, Centering::cell}) {
        for (const std::array<std::int64_t, 3> size : {std::array<std::int64_t, 3>{9, 10, 11},
                                                       {5, 4, 6},
                                                       {17, 3, 2},
                                                       {30, 21, 13},
                                                       {2, 2, 2}}) {
            for (int round = 0; round < 6; ++round) {
                const Volume volume = lone_samples(size, centering, ++seed);
                const auto found = hull_of_shown_cells(volume, measure_bricks(volume), shows);
                const auto expected = all_shown_corners(volume);
                ASSERT_EQ(found.empty(), expected.empty());
                for (int direction = 0; direction < 20; ++direction) {
                    const glm::dvec3 along(normal(random), normal(random), normal(random));
                    const Spread f = reach_of(found, along), e = reach_of(expected, along);
                    EXPECT_EQ(f.lo, e.lo) << "seed " << seed;
                    EXPECT_EQ(f.hi, e.hi) << "seed " << seed;
                }
            }
        }
    }
}

TEST(ShownCells, ReachHalfAVoxelFromASheetAndOmitNaN) {
    const auto value = [](double x, double, double) {
        return x == 2 ? 200. : x > 5 ? double(NAN) : 0.;
    };
    const Volume volume = test::volume_of<float>(test::grid_of({9, 1, 4}, Centering::cell), value);
    const Spread x =
        reach_of(hull_of_shown_cells(volume, measure_bricks(volume), shows), {1, 0, 0});
    const Spread y =
        reach_of(hull_of_shown_cells(volume, measure_bricks(volume), shows), {0, 1, 0});
    const Grid& grid = volume.grid();
    EXPECT_EQ(x.lo, grid.to_world({1, 0, 0}).x);
    EXPECT_EQ(x.hi, grid.to_world({3, 0, 0}).x);
    EXPECT_EQ(y.lo, grid.to_world({0, -.5, 0}).y);
    EXPECT_EQ(y.hi, grid.to_world({0, .5, 0}).y);
}

// Files of the same data may store axes in opposite directions; the hull, and so the camera, must
// be the same.
TEST(ShownCells, DoNotDependOnTheDirectionOfStoredAxes) {
    const Volume volume = lone_samples({22, 19, 15}, Centering::cell, 5);
    Grid turned = volume.grid();
    turned.origin = volume.grid().to_world({21, 0, 14});
    turned.step[0] = -turned.step[0];
    turned.step[2] = -turned.step[2];
    const auto* const samples = static_cast<const std::uint8_t*>(volume.data());
    const Volume mirrored =
        test::volume_of<std::uint8_t>(turned, [&](double x, double y, double z) {
            return double(samples[std::size_t(((14 - z) * 19 + y) * 22 + 21 - x)]);
        });
    const auto one = hull_of_shown_cells(volume, measure_bricks(volume), shows);
    const auto other = hull_of_shown_cells(mirrored, measure_bricks(mirrored), shows);
    for (const glm::dvec3& along :
         {glm::dvec3(1, 0, 0), {0, 1, 0}, {0, 0, 1}, {1, 2, -3}, {-.5, .25, 1}}) {
        // With a spacing of 1, positions of samples and half voxels are exact.
        EXPECT_EQ(reach_of(one, along).lo, reach_of(other, along).lo);
        EXPECT_EQ(reach_of(one, along).hi, reach_of(other, along).hi);
    }
}

// For large volumes (large_volume, choice/field.h) the hull is that of bricks. The samples, here
// all 0, are not read.
TEST(ShownCells, AreWholeBricksInLargeVolumes) {
    const Grid grid = test::grid_of({1024, 1024, 258}, Centering::node);
    const auto samples =
        std::make_shared<ReservedMemory>(static_cast<std::size_t>(grid.sample_count()));
    const Volume volume(grid, SampleType::uint8,
                        std::shared_ptr<const void>(samples, samples->data()));
    MinMaxBricks bricks = MinMaxBricks::of(grid, SampleType::uint8);
    const auto show = [&](std::int64_t x, std::int64_t y, std::int64_t z) {
        const std::int64_t brick = (z * bricks.count[1] + y) * bricks.count[0] + x;
        bricks.ranges.set<std::uint8_t>(static_cast<std::size_t>(brick), 5, 101);
    };
    show(7, 30, 2);
    show(9, 30, 2);
    show(200, 255, 64);  // the last brick along y and z, which have 1023 and 257 cells
    const auto points = hull_of_shown_cells(volume, bricks, shows);
    const auto expect_reach = [&](const glm::dvec3& axis, double lo, double hi) {
        const Spread reach = reach_of(points, axis);
        EXPECT_EQ(reach.lo, lo);
        EXPECT_EQ(reach.hi, hi);
    };
    expect_reach({1, 0, 0}, 7 * 4, 201 * 4);
    expect_reach({0, 1, 0}, 30 * 4, 1023);
    expect_reach({0, 0, 1}, 2 * 4, 257);
    EXPECT_EQ(points.size(), 16u);
}

// The values of samples of which a clip keeps a part, by testing every voxel's corners.
std::vector<double> kept_by_search(const Volume& volume, const std::vector<IndexPlane>& planes) {
    const auto& size = volume.grid().size;
    const auto* const samples = static_cast<const std::int16_t*>(volume.data());
    std::set<double> kept;
    for (std::int64_t i = 0; i < size[0] * size[1] * size[2]; ++i) {
        const glm::dvec3 at(i % size[0], i / size[0] % size[1], i / size[0] / size[1]);
        const bool all = std::ranges::all_of(planes, [&](const IndexPlane& plane) {
            bool any = false;
            for (int corner = 0; corner < 8; ++corner) {
                const glm::dvec3 side(corner & 1, corner >> 1 & 1, corner >> 2);
                any |= plane.distance(at + side) > 0;  // the voxel of sample i spans i .. i + 1
            }
            return any;
        });
        if (all) kept.insert(samples[i]);
    }
    return {kept.begin(), kept.end()};
}

TEST(KeptValues, AreThoseOfVoxelsThatNoPlaneCutsAway) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> any(-1, 1);
    for (int trial = 0; trial < 40; ++trial) {
        Grid grid = test::grid_of({7, 5, 6}, Centering::cell);
        grid.lookup = VolumeLookup::nearest;
        grid.step[1] = -grid.step[1];
        const Volume volume = test::volume_of<std::int16_t>(
            grid, [](double x, double y, double z) { return x + 7 * y + 35 * z - 100; });
        Clip clip;
        for (int plane = 0; plane < 2; ++plane) {
            const glm::dvec3 place(any(random), any(random), any(random));
            clip.planes.push_back({grid.to_world({3 + 3 * place.x, 2 + 2 * place.y, 3}),
                                   {any(random), any(random), trial % 2 ? any(random) : 0}});
        }
        if (trial % 3 == 0) clip.planes[0].normal = {0, 1, 0};
        const auto kept = VolumeField(volume, measure_bricks(volume)).kept_values(clip);
        ASSERT_TRUE(kept);
        EXPECT_EQ(*kept, kept_by_search(volume, index_planes(clip, grid))) << trial;
        for (const Volume& one : {volume, test::stored(volume)}) {
            const ValueRange range = VolumeField(one, measure_bricks(volume)).kept_range(clip);
            const ValueRange expected =
                kept->empty() ? ValueRange() : ValueRange{kept->front(), kept->back()};
            EXPECT_EQ(range, expected) << trial;
        }
    }
}

// Labels 0 to 3 along x: the legend has those of which the clip keeps something.
TEST(KeptValues, AreTheLabelsOfALegend) {
    Grid grid = test::grid_of({4, 3, 2}, Centering::cell);
    grid.lookup = VolumeLookup::nearest;
    const Volume volume =
        test::volume_of<std::uint8_t>(grid, [](double x, double, double) { return x; });
    const auto bricks = measure_bricks(volume);
    const VolumeField field(volume, bricks);
    Annotations wanted;
    wanted.labels.emplace();
    const auto listed = [&](const Clip& clip) {
        std::vector<double> codes;
        for (const Label& label : annotated_data(field, wanted, clip).labels)
            codes.push_back(label.code);
        return codes;
    };
    using Codes = std::vector<double>;
    EXPECT_EQ(listed({}), (Codes{0, 1, 2, 3}));
    const double edge = grid.origin.x + 1.5 * grid.step[0].x;  // between labels 1 and 2
    EXPECT_EQ(listed({{{{edge, 0, 0}, {1, 0, 0}}}, {}}), (Codes{2, 3}));
    EXPECT_EQ(listed({{{{edge - 1e-3, 0, 0}, {1, 0, 0}}}, {}}), (Codes{1, 2, 3}));
    const glm::dvec3 low = grid.to_world({1.1, -1, -1}), high = grid.to_world({1.9, 9, 9});
    EXPECT_EQ(listed({{}, ClipBox{low, high}}), Codes{1});
    EXPECT_EQ(listed({{{{99, 0, 0}, {1, 0, 0}}}, {}}), Codes{});
}

// A bright border, a clip that cuts it away, and values that are not finite.
TEST(KeptValues, AreTheRangeOfAColorBar) {
    const Grid grid = test::grid_of({6, 5, 4}, Centering::node);
    const Volume volume = test::volume_of<float>(grid, [](double x, double y, double) {
        return x == 0 ? 1000. : y == 2 ? NAN : x + 10 * y;
    });
    const auto bricks = measure_bricks(volume);
    const VolumeField field(volume, bricks);
    const Clip inside{{{grid.to_world({1, 0, 0}), {1, 0, 0}}}, {}};
    const Clip nothing{{{grid.to_world({9, 0, 0}), {1, 0, 0}}}, {}};
    Annotations wanted;
    EXPECT_EQ(annotated_data(field, wanted, inside).range, (ValueRange{1, 1000}));
    wanted.colorbar.emplace();
    EXPECT_EQ(annotated_data(field, wanted).range, (ValueRange{1, 1000}));
    EXPECT_EQ(annotated_data(field, wanted, inside).range, (ValueRange{1, 45}));
    // Between two samples both count: there the field goes up to 600.
    const Clip between{{{grid.to_world({0.4, 0, 0}), {1, 0, 0}}}, {}};
    EXPECT_EQ(annotated_data(field, wanted, between).range, (ValueRange{1, 1000}));
    EXPECT_EQ(annotated_data(field, wanted, nothing).range, (ValueRange{1, 1000}));
}

}  // namespace
}  // namespace lamina
