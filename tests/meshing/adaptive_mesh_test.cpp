// SPDX-License-Identifier: Apache-2.0
#include "meshing/volume_mesh.h"

#include <gtest/gtest.h>

#include "meshing/delaunay.h"
#include "support/expect_error.h"
#include "support/mesh_checks.h"
#include "volume/generate.h"

namespace lamina {
namespace {

using namespace test;

// Skips the tests if there was no TetGen when the build made lamina-tetrahedralize.
class AdaptiveMesh : public testing::Test {
  protected:
    void SetUp() override {
        if (std::string(LAMINA_TETRAHEDRALIZE_BINARY).empty()) {
            GTEST_SKIP() << "built without TetGen";
        }
    }

    static MeshData make(const Volume& volume, const MeshSettings& settings, MeshReport& report,
                         const TransferFunction* transfer_function = nullptr) {
        const TrilinearField field(volume);
        const CellRanges ranges(field);
        const InterpolationError error(field, ranges, transfer_function);
        report = {};
        report.range = field.range().hi - field.range().lo;
        const auto delaunay = [](std::span<const glm::dvec3> points) {
            return delaunay_by_process(LAMINA_TETRAHEDRALIZE_BINARY, points);
        };
        return make_adaptive_mesh(field, error, delaunay, settings, report);
    }

    static Grid index_grid(const Volume& volume) {
        Grid grid;
        grid.size = volume.grid().size;
        grid.centering = volume.grid().centering;
        return grid;
    }

    static Volume in_index_space(const Volume& volume) {
        return Volume(index_grid(volume), volume.type(),
                      std::shared_ptr<const void>(std::shared_ptr<void>(), volume.data()));
    }
};

Volume generated(const std::string& name, std::int64_t n) {
    GeneratorRequest request;
    request.name = name;
    request.size = {n, n, n};
    return generate(request);
}

TEST_F(AdaptiveMesh, KeepsTheToleranceWithFarFewerTetsThanKuhn) {
    const Volume volume = generated("gaussians", 24);
    MeshSettings settings;
    MeshReport report;
    const MeshData mesh = make(volume, settings, report);
    EXPECT_TRUE(report.within_tolerance);
    EXPECT_FALSE(report.stopped_by_max_tets);
    EXPECT_LE(report.error, 0.02 * report.range);
    // The error is sampled at points that InterpolationError does not know.
    EXPECT_LE(sampled_error(mesh, in_index_space(volume), 10), report.error + 1e-10);
    EXPECT_LT(mesh.tets.size(), 6u * 23 * 23 * 23 / 3);
    expect_fills_box(mesh, index_grid(volume));
}

// Noise needs points inside cells. Tests cells of half a sample and axes of one sample, too.
TEST_F(AdaptiveMesh, KeepsTheToleranceInNoise) {
    for (const auto& size : {std::array<std::int64_t, 3>{5, 4, 6}, {1, 7, 5}, {1, 1, 4}}) {
        for (const Centering centering : {Centering::node, Centering::cell}) {
            const Volume volume = noise(grid_of(size, centering), 1);
            MeshSettings settings;
            settings.tolerance = 0.04;
            MeshReport report;
            const MeshData mesh = make(volume, settings, report);
            EXPECT_TRUE(report.within_tolerance);
            EXPECT_LE(sampled_error(mesh, volume, 10), 0.04 * report.range + 1e-10);
            expect_fills_box(mesh, volume.grid());
        }
    }
}

TEST_F(AdaptiveMesh, ConstantAndLinearFieldsNeedTheCornersAlone) {
    const Grid grid = grid_of({9, 9, 9}, Centering::node);
    for (const double slope : {0.0, 1.0}) {
        const Volume volume = volume_of(
            grid, [&](double i, double j, double k) { return 7 + slope * (i + 2 * j - k); });
        MeshReport report;
        const MeshData mesh = make(volume, {}, report);
        EXPECT_EQ(mesh.points.size(), 8u);
        EXPECT_GE(mesh.tets.size(), 5u);
        EXPECT_LE(mesh.tets.size(), 6u);
        EXPECT_LT(report.error, 1e-12);
        EXPECT_TRUE(report.within_tolerance);
        expect_fills_box(mesh, grid);
    }
}

TEST_F(AdaptiveMesh, StopsAtMaxTetsAndSaysWhatWasReached) {
    const Volume volume = noise(grid_of({8, 8, 8}, Centering::node), 2);
    MeshSettings settings;
    settings.max_tets = 3000;
    MeshReport report;
    const MeshData mesh = make(volume, settings, report);
    EXPECT_LE(mesh.tets.size(), 3000u);
    EXPECT_GT(mesh.tets.size(), 2800u);
    EXPECT_TRUE(report.stopped_by_max_tets);
    EXPECT_FALSE(report.within_tolerance);
    EXPECT_GT(report.error, 0.02 * report.range);
    const double sampled = sampled_error(mesh, volume, 50);
    EXPECT_LE(sampled, report.error);
    EXPECT_GT(sampled, 0.5 * report.error);  // the bound is not far above the true error
    expect_fills_box(mesh, volume.grid());

    settings.max_tets = 5;
    expect_error([&] { make(volume, settings, report); }, {"6 tets", "5", "--max-tets"});
}

TEST_F(AdaptiveMesh, StaysCoarseWhereNothingIsVisible) {
    const Volume volume = generated("gaussians", 20);
    const auto upper_half = TransferFunction::linear(
        {{128, {{1, 1, 1}, 0}}, {130, {{1, 1, 1}, 9}}, {255, {{1, 1, 1}, 9}}});
    const auto nothing = TransferFunction::linear({{0, {{1, 1, 1}, 0}}});
    MeshReport all, half, none;
    make(volume, {}, all);
    const MeshData mesh = make(volume, {}, half, &upper_half);
    make(volume, {}, none, &nothing);
    EXPECT_LT(half.rounds, 100);
    EXPECT_TRUE(half.within_tolerance);
    const MeshData everything = make(volume, {}, all);
    EXPECT_LT(mesh.tets.size(), everything.tets.size());
    EXPECT_EQ(make(volume, {}, none, &nothing).points.size(), 8u);
    // If the field or the mesh shows something at a place, the tolerance holds there.
    double worst = 0;
    const Volume index = in_index_space(volume);
    for (const Tet& tet : mesh.tets) {
        glm::dvec3 middle(0);
        double linear = 0;
        for (const std::int32_t corner : tet) {
            middle += 0.25 * mesh.points[corner];
            linear += 0.25 * mesh.point_scalars[0].values[corner];
        }
        const double field = trilinear_at(index, middle);
        if (std::max(field, linear) > 128) worst = std::max(worst, std::abs(field - linear));
    }
    EXPECT_LE(worst, 0.02 * half.range + 1e-10);
}

TEST_F(AdaptiveMesh, IsTheSameEveryTime) {
    const Volume volume = generated("marschner-lobb", 7);
    MeshReport report;
    const MeshData first = make(volume, {}, report), second = make(volume, {}, report);
    EXPECT_EQ(first.tets, second.tets);
    EXPECT_EQ(first.points, second.points);
}

// Tests the conversion to world space, which make_volume_mesh() adds.
TEST_F(AdaptiveMesh, FillsTurnedAndMirroredBoxes) {
    Grid grid = grid_of({8, 9, 7}, Centering::cell);
    grid.origin = {100, -3, 7};
    grid.step = {glm::dvec3{0.6, 0.8, 0}, glm::dvec3{-1.6, 1.2, 0}, glm::dvec3{0, 0, -0.3}};
    const Volume volume = volume_of<std::uint8_t>(grid, [](double i, double j, double k) {
        return 120 + 100 * std::sin(i / 2 + j) * std::cos(k / 2);
    });
    MeshSettings settings;
    settings.tolerance = 0.05;
    const TrilinearField field(volume);
    const CellRanges ranges(field);
    MeshReport report;
    report.range = field.range().hi - field.range().lo;
    const auto delaunay = [](std::span<const glm::dvec3> points) {
        return delaunay_by_process(LAMINA_TETRAHEDRALIZE_BINARY, points);
    };
    MeshData mesh = make_adaptive_mesh(field, InterpolationError(field, ranges, nullptr), delaunay,
                                       settings, report);
    place_in_world(mesh, grid);
    EXPECT_TRUE(report.within_tolerance);
    EXPECT_LE(sampled_error(mesh, volume, 5), 0.05 * report.range + 1e-9);
    expect_fills_box(mesh, grid);
}

// Tests answers that no Delaunay program may give.
TEST(AdaptiveMeshFailures, IncludeWrongAnswersOfTheDelaunayProgram) {
    const Volume volume = noise(grid_of({3, 3, 3}, Centering::node), 3);
    const TrilinearField field(volume);
    const CellRanges ranges(field);
    const InterpolationError error(field, ranges, nullptr);
    MeshReport report;
    const auto one_tet = [](std::span<const glm::dvec3>) {
        return DelaunayTets{{{0, 1, 2, 4}}, {{-1, -1, -1, -1}}};
    };
    const auto inside_out = [](std::span<const glm::dvec3>) {
        return DelaunayTets{{{1, 0, 2, 4}}, {{-1, -1, -1, -1}}};
    };
    expect_error([&] { make_adaptive_mesh(field, error, one_tet, {}, report); },
                 {"do not fill the box", "4 points left out"});
    expect_error([&] { make_adaptive_mesh(field, error, inside_out, {}, report); },
                 {"1 tets without positive volume"});
}

}  // namespace
}  // namespace lamina
