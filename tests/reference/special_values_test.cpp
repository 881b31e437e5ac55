// SPDX-License-Identifier: Apache-2.0
// Tests NaN and infinite samples, values exactly on steps, and transparent regions.
#include <gtest/gtest.h>

#include "fixtures.h"

namespace lamina {
namespace {

using namespace reference_test;

double alpha_along_x(const Volume& volume, const TransferFunction& function, double y, double z,
                     std::int64_t* segments = nullptr) {
    Camera camera;
    camera.projection = Projection::orthographic;
    camera.eye = {-5, y, z};
    camera.center = {0, y, z};
    const TraceResult result = trace_volume(volume, function, View(camera, 1, 1), {});
    if (segments) *segments = result.segments;
    return result.image.rgba[3];
}

TEST(SpecialValues, CellsAroundANonFiniteSampleAreTransparent) {
    for (const float bad :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
          -std::numeric_limits<float>::infinity()}) {
        const Grid grid = make_grid({9, 3, 3}, Centering::node);
        std::vector<float> samples(81, 1.0f);
        samples[9 * 3 + 4] = bad;  // sample (4, 0, 1): cells x 3 and 4, y 0, z 0 and 1
        const Volume volume = make_volume<float>(grid, samples);
        const TransferFunction function = constant_function(0.25, glm::dvec3(1));
        EXPECT_NEAR(alpha_along_x(volume, function, 0.5, 0.5), -std::expm1(-0.25 * 6), 1e-15);
        EXPECT_NEAR(alpha_along_x(volume, function, 0.5, 1.5), -std::expm1(-0.25 * 6), 1e-15);
        EXPECT_NEAR(alpha_along_x(volume, function, 1.5, 0.5), -std::expm1(-0.25 * 8), 1e-15);
    }
}

TEST(SpecialValues, VolumesWithoutFiniteSamplesShowNothing) {
    const Grid grid = make_grid({3, 3, 3}, Centering::cell);
    const Volume volume =
        make_volume<float>(grid, std::vector<float>(27, std::numeric_limits<float>::quiet_NaN()));
    EXPECT_EQ(alpha_along_x(volume, constant_function(1, glm::dvec3(1)), 1, 1), 0);
}

// A constant field exactly on a step has the optics of TransferFunction::at(): the later knot's.
TEST(SpecialValues, ConstantsOnStepsShowTheLaterSide) {
    const TransferFunction up = TransferFunction::linear(
        {{0, {glm::dvec3(1), 0}}, {5, {glm::dvec3(1), 0}}, {5, {glm::dvec3(1), 0.5}}});
    const TransferFunction down = TransferFunction::linear(
        {{0, {glm::dvec3(1), 0.5}}, {5, {glm::dvec3(1), 0.5}}, {5, {glm::dvec3(1), 0}}});
    const Grid grid = make_grid({3, 3, 3}, Centering::node);
    const Volume volume = make_volume<std::int16_t>(grid, std::vector<std::int16_t>(27, 5));
    EXPECT_NEAR(alpha_along_x(volume, up, 0.5, 0.5), -std::expm1(-0.5 * 2), 1e-15);
    EXPECT_EQ(alpha_along_x(volume, down, 0.5, 0.5), 0);
    // This field is constant only along the ray: in the plane between cells where it is 5 (and in
    // the last plane of the box).
    std::vector<std::int16_t> ramp;
    for (int i = 0; i < 27; ++i) ramp.push_back(static_cast<std::int16_t>(4 + i / 3 % 3));
    const Volume ramp_volume = make_volume<std::int16_t>(grid, ramp);
    EXPECT_NEAR(alpha_along_x(ramp_volume, up, 1, 0.5), -std::expm1(-0.5 * 2), 1e-15);
    EXPECT_EQ(alpha_along_x(ramp_volume, down, 1, 0.5), 0);
    for (std::int16_t& value : ramp) --value;
    const Volume lower = make_volume<std::int16_t>(grid, ramp);
    EXPECT_NEAR(alpha_along_x(lower, up, 2, 0.5), -std::expm1(-0.5 * 2), 1e-15);
    EXPECT_EQ(alpha_along_x(lower, down, 2, 0.5), 0);
}

// In a palette, optics are constant between steps, so the depth along a ramp is a weighted sum.
TEST(SpecialValues, PalettesStepHalfwayBetweenPoints) {
    const Grid grid = make_grid({5, 2, 2}, Centering::node);
    std::vector<std::uint8_t> samples;
    for (int i = 0; i < 20; ++i) samples.push_back(static_cast<std::uint8_t>(i % 5));
    const TransferFunction palette = TransferFunction::nearest({{0, {glm::dvec3(1), 0.1}},
                                                                {1, {glm::dvec3(1), 0}},
                                                                {2, {glm::dvec3(1), 0.7}},
                                                                {4, {glm::dvec3(1), 0.2}}});
    // The steps lie halfway between points: at 0.5, 1.5 and 3.
    const double depth = 0.1 * 0.5 + 0 * 1 + 0.7 * 1.5 + 0.2 * 1;
    EXPECT_NEAR(alpha_along_x(make_volume<std::uint8_t>(grid, samples), palette, 0.5, 0.5),
                -std::expm1(-depth), 1e-15);
}

TEST(SpecialValues, TransparentCellsAreNotIntegrated) {
    const Grid grid = make_grid({9, 2, 2}, Centering::node);
    std::vector<std::uint8_t> samples;
    for (int i = 0; i < 36; ++i) samples.push_back(static_cast<std::uint8_t>(i % 9));
    const TransferFunction peak = TransferFunction::linear(
        {{3.25, {glm::dvec3(1), 0}}, {3.5, {glm::dvec3(1), 1}}, {3.75, {glm::dvec3(1), 0}}});
    std::int64_t segments = 0;
    const double alpha =
        alpha_along_x(make_volume<std::uint8_t>(grid, samples), peak, 0.5, 0.5, &segments);
    EXPECT_NEAR(alpha, -std::expm1(-0.25), 1e-15);
    EXPECT_EQ(segments, 2);  // the two flanks, in one cell
}

// On `cell` axes the box extends by half a voxel at both ends, where the border value repeats.
TEST(SpecialValues, BorderValuesRepeatForHalfAVoxel) {
    const Grid grid = make_grid({3, 1, 1}, Centering::cell);
    const Volume volume = make_volume<std::uint8_t>(grid, {0, 1, 3});
    const TransferFunction identity =
        TransferFunction::linear({{0, {glm::dvec3(1), 0}}, {4, {glm::dvec3(1), 4}}});
    // Values: 0 and 3 in half voxels at the ends, and means of 0.5 and 2 between the samples.
    const double depth = 0.5 * 0 + 0.5 + 2 + 0.5 * 3;
    EXPECT_NEAR(alpha_along_x(volume, identity, 0.25, -0.25), -std::expm1(-depth), 1e-15);
}

}  // namespace
}  // namespace lamina
