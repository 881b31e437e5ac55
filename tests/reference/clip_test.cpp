// SPDX-License-Identifier: Apache-2.0
// Tests clipped volumes and meshes against closed forms, and against volumes that are cropped
// instead.
#include "support/clips.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/glm.hpp>

#include "base/error.h"
#include "fixtures.h"
#include "optics/segment_integral.h"
#include "reference/chord.h"
#include "reference/tracer.h"
#include "support/split_box.h"
#include "support/volume_of.h"

namespace lamina {
namespace {

using reference_test::camera_at;
using reference_test::make_grid;

std::vector<View> views() {
    std::vector<View> found;
    for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
        for (const double distance : {1e-3, .4, 2.0})
            found.emplace_back(camera_at(unit_box, projection, {.5, .3, 1}, distance), 24, 20);
    }
    return found;
}

// Largest difference of lengths that come from the same exact numbers: a few epsilons of the
// distance, up to 4.
constexpr double length_error = 1e-14;

TEST(ClippedTracer, ChordsEndAtThePlanes) {
    for (const test::NamedClip& named : test::clips_of_unit_box()) {
        const std::vector<HalfSpace> clip = half_spaces(named.clip);
        for (const View& view : views()) {
            for (int y = 0; y < view.height; ++y) {
                for (int x = 0; x < view.width; ++x) {
                    const View::Ray ray = view.ray(x, y);
                    ASSERT_NEAR(clip_to_box(unit_box, ray, clip).world_length(),
                                test::kept_length(named.clip, ray, {0, 0, 0}, {1, 1, 1}),
                                length_error)
                        << named.name;
                }
            }
        }
    }
}

// Clipped meshes of one value, as mesh_tracer_test.cpp traces them whole.
TEST(ClippedTracer, HomogeneousMeshesEqualTheClosedForm) {
    const MeshData data = test::split_box(3, 4000, 1e-3, [](const glm::dvec3&) { return .25; });
    const TetMesh mesh(data, "test");
    const FaceTree tree(mesh, mesh.open_faces());
    const auto transfer = TransferFunction::linear({{0, {glm::dvec3(.2, .5, 1), 3}}});
    for (const test::NamedClip& named : test::clips_of_unit_box()) {
        for (const View& view : views()) {
            const TraceResult result =
                trace_mesh(mesh, tree, mesh.point_scalars()[0].values, transfer, view,
                           {.clip = half_spaces(named.clip)});
            for (int y = 0; y < view.height; ++y) {
                for (int x = 0; x < view.width; ++x) {
                    const double length =
                        test::kept_length(named.clip, view.ray(x, y), {0, 0, 0}, {1, 1, 1});
                    ASSERT_NEAR(result.image.pixel(x, y)[3], -std::expm1(-3 * length), 1e-12)
                        << named.name;
                }
            }
        }
    }
}

// In a linear field with a ramp of four pieces, the kept part of a ray is one segment in closed
// form.
TEST(ClippedTracer, LinearFieldsEqualOneSegment) {
    const auto field = [](const glm::dvec3& p) { return .5 * p.x + .3 * p.y + .2 * p.z; };
    const auto transfer = TransferFunction::linear({{0, {glm::dvec3(.1, .8, 0), 0}},
                                                    {.3, {glm::dvec3(1, .2, .4), .6}},
                                                    {.6, {glm::dvec3(0, 0, 1), 6}},
                                                    {1, {glm::dvec3(.3, 1, .2), 3}}});
    const MeshData data = test::split_box(5, 3000, 1e-3, field);
    const TetMesh mesh(data, "test");
    const FaceTree tree(mesh, mesh.open_faces());
    const Volume volume = test::volume_of(unit_box, [&](double x, double y, double z) {
        return field({x, y, z});
    });
    for (const test::NamedClip& named : test::clips_of_unit_box()) {
        const std::vector<HalfSpace> clip = half_spaces(named.clip);
        for (const View& view : views()) {
            const TraceResult of_mesh = trace_mesh(mesh, tree, mesh.point_scalars()[0].values,
                                                   transfer, view, {.clip = clip});
            const TraceResult of_volume =
                trace_volume(volume, transfer, view, {.tolerance = 1e-9, .clip = clip});
            EXPECT_LT(of_mesh.error_estimate, 1e-10);
            for (int y = 0; y < view.height; ++y) {
                for (int x = 0; x < view.width; ++x) {
                    const Chord chord = clip_to_box(unit_box, view.ray(x, y), clip);
                    const SegmentIntegral expected =
                        integrate_segment(transfer, field(chord.entry),
                                          field(chord.entry + chord.length_z * chord.direction),
                                          chord.world_length());
                    for (int c = 0; c < 4; ++c) {
                        const double value = c < 3 ? expected.color[c] : expected.alpha;
                        ASSERT_NEAR(of_mesh.image.pixel(x, y)[c], value,
                                    of_mesh.error_estimate + 1e-13)
                            << named.name;
                        // Samples are float32, so values are off by 6e-8 of a range over which
                        // extinction changes by 6 and colour by 1.
                        ASSERT_NEAR(of_volume.image.pixel(x, y)[c], value, 1e-9 + 6 * 2 * 6e-8)
                            << named.name;
                    }
                }
            }
        }
    }
}

// A volume clipped along planes of samples must look like one that has only the kept samples.
TEST(ClippedTracer, ClippedNoiseIsCroppedNoise) {
    std::array<double, 7 * 6 * 8> values{};
    std::mt19937 random(5);
    for (double& value : values) value = static_cast<double>(random() % 256);
    const auto sample = [&](double i, double j, double k) {
        return values[static_cast<std::size_t>((k * 6 + j) * 7 + i)];
    };
    Grid grid = make_grid({7, 6, 8}, Centering::node);
    grid.origin = {3, -2, 11};
    grid.step = {glm::dvec3(0, .5, 0), glm::dvec3(-2, 0, 0), glm::dvec3(0, 0, .75)};
    Grid part = grid;
    part.size = {4, 4, 4};
    part.origin = grid.to_world({2, 1, 3});
    const Volume whole = test::volume_of<std::uint8_t>(grid, sample);
    const Volume cropped = test::volume_of<std::uint8_t>(
        part, [&](double i, double j, double k) { return sample(i + 2, j + 1, k + 3); });
    const glm::dvec3 a = grid.to_world({2, 1, 3}), b = grid.to_world({5, 4, 6});
    Clip clip;
    clip.box = ClipBox{glm::min(a, b), glm::max(a, b)};
    const auto transfer = TransferFunction::linear({{40, {glm::dvec3(1, .2, .4), 0}},
                                                    {120, {glm::dvec3(0, .7, 1), 2}},
                                                    {200, {glm::dvec3(.3, 1, .2), .3}}});
    for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
        const View view(camera_at(grid, projection, {.5, .3, 1}, .8), 40, 30);
        const TraceResult one =
            trace_volume(whole, transfer, view, {.tolerance = 1e-10, .clip = half_spaces(clip)});
        const TraceResult other = trace_volume(cropped, transfer, view, {1e-10});
        double largest = 0;
        for (std::size_t i = 0; i < one.image.rgba.size(); ++i) {
            ASSERT_NEAR(one.image.rgba[i], other.image.rgba[i], 2.1e-10);
            largest = std::max(largest, one.image.rgba[i]);
        }
        EXPECT_GT(largest, .2);
    }
}

TEST(ClippedTracer, InvalidNormalsAreErrors) {
    for (const double z : {0., std::nan(""), HUGE_VAL}) {
        Clip clip;
        clip.planes = {{{0, 0, 0}, {0, 0, z}}};
        EXPECT_THROW(half_spaces(clip), Error);
    }
}

}  // namespace
}  // namespace lamina
