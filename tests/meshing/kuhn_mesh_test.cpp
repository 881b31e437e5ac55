// SPDX-License-Identifier: Apache-2.0
#include "meshing/volume_mesh.h"

#include <gtest/gtest.h>

#include <limits>

#include "support/expect_error.h"
#include "support/mesh_checks.h"

namespace lamina {
namespace {

using namespace test;

MeshSettings kuhn() {
    MeshSettings settings;
    settings.kuhn = true;
    return settings;
}

TEST(TrilinearField, PlanesFollowTheCentring) {
    const auto planes = [](std::int64_t samples, Centering centering) {
        const TrilinearField field(noise(grid_of({samples, 1, 1}, centering), 1));
        return std::vector<double>(field.planes(0).begin(), field.planes(0).end());
    };
    using Planes = std::vector<double>;
    EXPECT_EQ(planes(3, Centering::node), (Planes{0, 1, 2}));
    EXPECT_EQ(planes(3, Centering::cell), (Planes{-0.5, 0, 1, 2, 2.5}));
    EXPECT_EQ(planes(1, Centering::node), (Planes{-0.5, 0.5}));
    EXPECT_EQ(planes(1, Centering::cell), (Planes{-0.5, 0.5}));
}

TEST(TrilinearField, MatchesTheTrilinearFormula) {
    for (const Centering centering : {Centering::node, Centering::cell}) {
        const Volume volume = noise(grid_of({5, 4, 1}, centering), 2);
        const TrilinearField field(volume);
        std::mt19937 random(3);
        std::uniform_real_distribution<double> uniform(0, 1);
        for (int i = 0; i < 1000; ++i) {
            glm::dvec3 place(0);
            for (int axis = 0; axis < 3; ++axis) {
                const double share = i < 64 ? ((i >> 2 * axis) & 3) / 3.0 : uniform(random);
                place[axis] = field.min()[axis] + share * (field.max() - field.min())[axis];
            }
            // Rounding: values up to 255, three roundings an axis: 255 * 9 * 2^-53 is 3e-13.
            EXPECT_NEAR(field.at(place), trilinear_at(volume, place), 1e-12);
        }
    }
}

TEST(TrilinearField, RejectsNaNSamples) {
    const Volume volume =
        volume_of(grid_of({3, 3, 3}, Centering::node), [](double i, double j, double k) {
            return i + j + k == 3 ? std::numeric_limits<double>::quiet_NaN() : 0;
        });
    expect_error([&] { TrilinearField{volume}; }, {"7 of 27 samples", "NaN"});
}

TEST(KuhnMesh, FillsTheBoxOfEveryKindOfGrid) {
    Grid turned = grid_of({4, 3, 5}, Centering::node);
    turned.origin = {-3, 10, 2};
    turned.step = {glm::dvec3{0.6, 0.8, 0}, glm::dvec3{-1.6, 1.2, 0}, glm::dvec3{0, 0, 0.3}};
    Grid mirrored = turned;
    mirrored.step[2] = -mirrored.step[2];
    mirrored.centering[1] = Centering::cell;
    for (const Grid& grid :
         {turned, mirrored, grid_of({4, 3, 5}, Centering::cell),
          grid_of({1, 3, 5}, Centering::node), grid_of({1, 1, 1}, Centering::node)}) {
        const Volume volume = noise(grid, 4);
        MeshReport report;
        const MeshData mesh = make_volume_mesh(volume, kuhn(), nullptr, report);
        std::int64_t cells = 1;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::int64_t n = grid.size[axis];
            cells *= n == 1 ? 1 : grid.centering[axis] == Centering::cell ? n + 1 : n - 1;
        }
        EXPECT_EQ(report.tets, 6 * cells);
        EXPECT_EQ(report.kuhn_tets, report.tets);
        expect_fills_box(mesh, grid);
        for (std::size_t i = 0; i < mesh.points.size(); ++i) {
            // Rounding: converting to index space and back costs some roundings of coordinates near
            // 10, times slopes of up to 255 a sample: 255 * 10 * 1e-15.
            EXPECT_NEAR(mesh.point_scalars[0].values[i],
                        trilinear_at(volume, grid.to_index(mesh.points[i])), 1e-10);
        }
    }
}

TEST(KuhnMesh, IsExactForLinearFields) {
    const Volume volume =
        volume_of(grid_of({6, 5, 4}, Centering::node),
                  [](double i, double j, double k) { return 3 * i - 2 * j + 8 * k; });
    MeshReport report;
    const MeshData mesh = make_volume_mesh(volume, kuhn(), nullptr, report);
    EXPECT_LT(sampled_error(mesh, volume, 10), 1e-12);  // values up to 40
    // Errors below 1e-4 of the range are not told apart.
    EXPECT_LE(report.error, 1e-4 * report.range);
    EXPECT_TRUE(report.within_tolerance);
}

// In one cell with f = xy, the tets around the diagonal interpolate min(x, y). The difference from
// xy is largest in the middle: 1/2 - 1/4.
TEST(KuhnMesh, ReportsItsInterpolationError) {
    const Volume volume = volume_of(grid_of({2, 2, 2}, Centering::node),
                                    [](double i, double j, double) { return i * j; });
    MeshReport report;
    make_volume_mesh(volume, kuhn(), nullptr, report);
    EXPECT_GE(report.error, 0.25 - 1e-12);
    EXPECT_LE(report.error, 0.25 / 0.98);  // 0.98: ratio of found to bound
    EXPECT_FALSE(report.within_tolerance);
}

TEST(KuhnMesh, SaysWhenThereWouldBeTooManyTets) {
    MeshSettings settings = kuhn();
    settings.max_tets = 749;
    MeshReport report;
    const Volume volume = noise(grid_of({6, 6, 6}, Centering::node), 5);
    expect_error([&] { make_volume_mesh(volume, settings, nullptr, report); },
                 {"5 x 5 x 5 cells", "750", "749", "--max-tets"});
    settings.max_tets = 750;
    EXPECT_EQ(make_volume_mesh(volume, settings, nullptr, report).tets.size(), 750u);
}

}  // namespace
}  // namespace lamina
