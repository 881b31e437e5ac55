// SPDX-License-Identifier: Apache-2.0
// Tests that the reference tracer and its twin, the plain tracer, draw the same pictures.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/glm.hpp>
#include <limits>

#include "plain/plain_scenes.h"
#include "plain/plain_tracer.h"
#include "reference/lit_fixtures.h"
#include "reference/scene_tracer.h"
#include "scene_files/scene_reader.h"
#include "support/carved_mesh.h"
#include "support/clips.h"
#include "support/needle_soup.h"
#include "support/overlapping_tets.h"
#include "support/point_copies.h"
#include "support/scene_fixture.h"
#include "support/split_box.h"
#include "support/transfer_functions.h"
#include "support/volume_of.h"

namespace lamina {
namespace {

using namespace plain_test;

// Expects that the two pictures differ by no more than both error estimates and `rounding`.
// Functions of these tests are up to 1e4 times as steep as the numbers that round. The twin's
// estimate must be below 1e-5 in all scenes.
template <typename Data>
void expect_same(const Scene& scene, const Data& data, const std::string& what,
                 double rounding = 1e-11) {
    const auto traced = trace(scene, data);
    const PlainPicture plain = trace_plainly(scene, data);
    const double difference = largest_difference(traced.image, plain.image);
    EXPECT_LE(difference, traced.error_estimate + plain.error_estimate + rounding) << what;
    EXPECT_LE(difference, 1e-5) << what;
    EXPECT_LE(plain.error_estimate, 1e-6) << what;
}

// Returns noise in the unit box, between `low` and `high`, on cells or nodes.
template <typename Sample>
Volume noise_of(Centering centering, double low, double high) {
    constexpr std::array<std::int64_t, 3> size{5, 4, 3};
    Grid grid = make_grid(size, centering);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const bool node = centering == Centering::node;
        const double count = static_cast<double>(size[axis]) - (node ? 1 : 0);
        grid.step[axis] /= count;
        if (!node) grid.origin[static_cast<int>(axis)] = .5 / count;
    }
    Random random(7);
    return test::volume_of<Sample>(
        grid, [&](double, double, double) { return random.uniform(low, high); });
}

Volume noise() {
    return noise_of<float>(Centering::node, 0, 1);
}

SceneMesh waves(int splits, double least) {
    return mesh_of(test::split_box(6, splits, least, [](const glm::dvec3& p) {
        return .5 + .5 * std::sin(5 * p.x + 3 * p.y * p.z);
    }));
}

TEST(TracerAndTwin, AgreeOnSamplesOfAllTypesAndBothCenterings) {
    const auto function = [](double low, double high) {
        return TransferFunction::linear({{low, {{1, .2, .1}, 0}},
                                         {.5 * (low + high), {{.1, .8, 1}, 6}},
                                         {high, {{1, 1, 0}, 1}}});
    };
    for (const Camera& camera : views_of(unit_box)) {
        for (const Centering centering : {Centering::node, Centering::cell}) {
            const auto expect_of = [&]<typename Sample>(Sample, double low, double high) {
                expect_same(scene_of(function(low, high), camera),
                            noise_of<Sample>(centering, low, high), name_of(camera.projection));
            };
            expect_of(std::uint8_t{}, 0, 255);
            expect_of(std::int16_t{}, -2000, 3000);
            expect_of(std::uint16_t{}, 0, 65535);
            expect_of(float{}, -1, 1);
        }
    }
}

// The field is constant in each voxel, so that light changes nothing.
TEST(TracerAndTwin, AgreeOnVoxelsOfLabels) {
    for (const Centering centering : {Centering::node, Centering::cell}) {
        const Volume smooth = noise_of<std::uint8_t>(centering, 0, 255);
        Grid grid = smooth.grid();
        grid.lookup = VolumeLookup::nearest;
        const Volume voxels = smooth.on(grid);
        const auto function = TransferFunction::linear(
            {{0, {{1, .2, .1}, 0}}, {120, {{.1, .8, 1}, 6}}, {255, {{1, 1, 0}, 1}}});
        for (const Camera& camera : views_of(unit_box)) {
            Scene scene = scene_of(function, camera);
            expect_same(scene, voxels, name_of(camera.projection));
            const auto unlit = trace(scene, voxels);
            EXPECT_GT(largest_difference(unlit.image, trace(scene, smooth).image), .01);
            scene.lighting = directional();
            expect_same(scene, voxels, "lit");
            EXPECT_EQ(largest_difference(trace(scene, voxels).image, unlit.image), 0);
        }
    }
}

TEST(TracerAndTwin, AgreeOnTurnedGridsAndThinOnes) {
    Grid turned = make_grid({4, 3, 6}, Centering::cell);
    turned.step = {glm::dvec3(2, 1, 2) / 9., glm::dvec3(-4, 4, 2) / 15.,
                   glm::dvec3(1, 2, -2) / -12.};
    turned.origin = {100, -3, 7};
    Random random(3);
    const auto value = [&](double, double, double) { return random.uniform(); };
    for (const auto& size :
         {std::array<std::int64_t, 3>{4, 3, 6}, {1, 5, 1}, {7, 1, 2}, {1, 1, 1}}) {
        turned.size = size;
        for (const Camera& camera : views_of(turned))
            expect_same(scene_of(test::smooth(), camera), test::volume_of(turned, value), "");
    }
}

// Cells with such a corner show nothing, and gradients come from the finite neighbours.
TEST(TracerAndTwin, AgreeOnNonFiniteSamples) {
    constexpr float nan = NAN, infinite = INFINITY;
    Random random(5);
    const Volume volume =
        test::volume_of(make_grid({6, 6, 6}, Centering::cell), [&](double i, double j, double k) {
            if (i + j + k == 4) return nan;
            if (i == 5 && j > 3) return k > 2 ? infinite : -infinite;
            return static_cast<float>(random.uniform());
        });
    for (const Camera& camera : views_of(volume.grid())) {
        Scene scene = scene_of(test::smooth(), camera);
        scene.nan = NanPolicy::transparent;
        expect_same(scene, volume, "unlit");
        scene.lighting = directional();
        expect_same(scene, volume, "lit");
    }
}

// Colours are composited as given, in linear light or in display values, and may exceed 1.
TEST(TracerAndTwin, AgreeInBothColorSpaces) {
    for (const char* space : {"linear", "display"}) {
        nlohmann::json document = with("/image/color_space", space);
        document["transfer_function"]["points"] = {
            {{"value", 20}, {"color", "#102030"}, {"extinction", 0}},
            {{"value", 90}, {"color", "tomato"}, {"opacity", .8}},
            {{"value", 220}, {"color", {1, .5, 900}}, {"extinction", 5}}};
        document["volume"]["size"] = {8, 8, 8};
        Scene scene = read_scene(document, "s");
        scene.trace_tolerance = 1e-9;
        expect_same(scene, load_volume(scene), space);
    }
}

TEST(TracerAndTwin, AgreeOnLight) {
    const Volume volume = noise();
    const SceneMesh mesh = waves(30, .1);
    for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
        Scene scene =
            scene_of(test::smooth(), camera_at(unit_box, projection, {1, .4, .7}, .6), 12, 9);
        for (Lighting lighting : lightings()) {
            for (const double smallest : {1e-9, .05, 2.}) {
                lighting.smallest_gradient = smallest;
                scene.lighting = lighting;
                expect_same(scene, volume, "volume");
                expect_same(scene, mesh, "mesh");
            }
        }
    }
}

TEST(TracerAndTwin, AgreeOnClips) {
    const Volume volume = noise();
    const SceneMesh mesh = waves(100, .1);
    for (const Camera& camera : views_of(unit_box)) {
        for (const auto& [name, clip] : test::clips_of_unit_box()) {
            Scene scene = scene_of(test::smooth(), camera, 12, 9);
            scene.clip = clip;
            expect_same(scene, volume, name);
            expect_same(scene, mesh, name);
            if (name != "a wedge") continue;
            scene.lighting = directional();
            expect_same(scene, volume, name + ", lit");
            expect_same(scene, mesh, name + ", lit");
        }
    }
}

// Steps lie at values that samples, and plateaus of samples, have.
TEST(TracerAndTwin, AgreeOnKnotsThatCoincide) {
    Random random(11);
    const Volume volume =
        test::volume_of<std::uint8_t>(make_grid({6, 6, 6}, Centering::node),
                                      [&](double, double, double) { return random.below(4); });
    for (const std::vector<double>& steps : {std::vector<double>{2}, {1, 2, 3}, {0, .5, 3}}) {
        std::vector<TransferKnot> knots;
        for (const double step : steps) {
            knots.push_back({step, {random.point(), random.uniform(0, 3)}});
            knots.push_back({step, {random.point(), random.below(2) * 2.}});
        }
        for (const Camera& camera : views_of(volume.grid()))
            expect_same(scene_of(TransferFunction::linear(knots), camera), volume, "");
        expect_same(scene_of(TransferFunction::nearest(knots), views_of(volume.grid())[0]), volume,
                    "nearest");
    }
}

// Functions: a peak of 1e-5 of the range, a step to opaque, and many knots of linear opacity.
TEST(TracerAndTwin, AgreeOnSteepFunctions) {
    const TransferFunction peak = TransferFunction::linear({{.3, {{1, 0, 0}, 0}},
                                                            {.300005, {{1, 1, 0}, 1e4}},
                                                            {.30001, {{0, 1, 0}, 0}},
                                                            {.7, {{0, .5, 1}, .5}},
                                                            {.7, {{.2, .5, 1}, 1e7}}});
    const TransferFunction opacity = TransferFunction::linear_opacity(
        {{.1, {1, 0, 0}, 0}, {.6, {0, 1, 0}, .9}, {.8, {0, 0, 1}, 1}}, .1);
    const Volume volume = noise();
    const SceneMesh mesh = waves(30, .1);
    for (const Camera& camera : views_of(unit_box)) {
        for (const TransferFunction& function : {peak, opacity}) {
            Scene scene = scene_of(function, camera, 12, 9);
            expect_same(scene, volume, "volume");
            expect_same(scene, mesh, "mesh");
            scene.lighting = directional();
            scene.width = 8;
            scene.height = 6;
            expect_same(scene, volume, "volume, lit");
            expect_same(scene, mesh, "mesh, lit");
        }
    }
}

// The heights of needles, 1e-6 of an edge and less, have lost six digits or more, and so have
// scalars in them.
TEST(TracerAndTwin, AgreeOnMeshesWithNeedles) {
    for (const double least : {.1, 1e-3, 1e-6}) {
        const SceneMesh mesh = waves(100, least);
        for (const Camera& camera : views_of(unit_box))
            expect_same(scene_of(test::smooth(), camera), mesh, std::to_string(least), 1e-9);
    }
}

// Every second ray lies in faces of tets, some of which are faces of the box.
TEST(TracerAndTwin, AgreeOnRaysInFaces) {
    const SceneMesh mesh = mesh_of(test::kuhn_box(
        {3, 3, 3}, [](const glm::dvec3& p) { return .1 * p.x * p.y + .2 * p.z + .05 * p.x; }));
    for (int axis = 0; axis < 3; ++axis) {
        Camera camera;
        camera.projection = Projection::orthographic;
        camera.eye = camera.center = glm::dvec3(1.5);
        camera.eye[axis] = -2;
        camera.up = glm::dvec3(0);
        camera.up[(axis + 1) % 3] = 1;
        camera.height = 4;
        Scene scene = scene_of(test::smooth(), camera, 17, 17);
        expect_same(scene, mesh, std::to_string(axis));
        scene.camera->height = 17. / 4;  // pixels .25 apart, around the middle of the box
        expect_same(scene, mesh, std::to_string(axis));
    }
}

// Each cell has its own points. The field jumps at all faces between cells, at a few, or at none.
TEST(TracerAndTwin, AgreeOnMeshesWhoseCellsShareNoPoints) {
    const MeshData box = test::kuhn_box(
        {2, 3, 2}, [](const glm::dvec3& p) { return .5 + .4 * std::sin(2 * p.x + p.y * p.z); });
    const auto at_few = [](std::size_t cell) { return cell == 4 ? .3 : 0; };
    for (const MeshData& data :
         {test::with_copies(box, 6, test::RandomJump{.4}), test::with_copies(box, 6, at_few),
          test::with_copies(box, 1, test::RandomJump{.2}),
          test::with_copies(box, 6, test::no_jump)}) {
        const SceneMesh mesh = mesh_of(data);
        for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
            for (const double distance : {3., .4}) {
                Scene scene = scene_of(test::smooth(), {});
                scene.camera = camera_at(make_grid({3, 4, 3}, Centering::node), projection,
                                         {1, .4, .7}, distance);
                expect_same(scene, mesh, "unlit");
                scene.lighting = directional();
                expect_same(scene, mesh, "lit");
                const TraceResult traced = trace(scene, mesh);
                EXPECT_EQ(traced.overlapping_rays, 0);
            }
        }
    }
}

TEST(TracerAndTwin, AgreeOnMeshesOfSeveralOrOverlappingParts) {
    MeshData hollow = test::carved(
        test::kuhn_box({5, 5, 5},
                       [](const glm::dvec3& p) { return .3 * std::fmod(p.x + 2 * p.y + p.z, 3.); }),
        [](const glm::dvec3& c) { return std::fmod(c.x + c.y, 2.) > .7 && c.z != 2; });
    MeshData overlapping = test::kuhn_box({2, 2, 2}, [](const glm::dvec3& p) { return .2 * p.x; });
    const MeshData other =
        test::kuhn_box({1, 1, 1}, [](const glm::dvec3& p) { return .9 - .5 * p.y; });
    const auto first = static_cast<std::int32_t>(overlapping.points.size());
    for (const glm::dvec3& point : other.points)
        overlapping.points.push_back(point + glm::dvec3(.31, .42, .53));
    for (const double value : other.point_scalars[0].values)
        overlapping.point_scalars[0].values.push_back(value);
    for (const Tet& t : other.tets)
        overlapping.tets.push_back({t[0] + first, t[1] + first, t[2] + first, t[3] + first});
    const MeshData needles = test::needle_soup(60, 3, .7, .02);
    hollow.point_scalars[0].values[70] = NAN;
    std::vector<MeshData> all{hollow, overlapping, needles};
    for (const test::OverlapCase& each : test::overlap_cases()) all.push_back(each.mesh);
    for (const MeshData& data : all) {
        const SceneMesh mesh = mesh_of(data);
        const auto& [low, high] = mesh.mesh.bounds();
        Grid box = unit_box;
        box.origin = low;
        for (int axis = 0; axis < 3; ++axis)
            box.step[static_cast<std::size_t>(axis)] *= high[axis] - low[axis];
        for (const Camera& camera : views_of(box))
            expect_same(scene_of(test::smooth(), camera), mesh, "");
    }
}

}  // namespace
}  // namespace lamina
