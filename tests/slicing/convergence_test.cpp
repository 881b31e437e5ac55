// SPDX-License-Identifier: Apache-2.0
// With more slabs, pictures converge to the reference tracer's, at the order that theory predicts.
#include <cmath>

#include "engine_fixture.h"
#include "slicing/slab_trials.h"
#include "volume/generate.h"

namespace lamina {
namespace {

double l2_against(const Image& reference, const Volume& volume, Scene scene, int samples,
                  const Capabilities& capabilities) {
    scene.slice.samples = samples;
    return image_error(render(volume, scene, capabilities), reference).all.l2;
}

// Returns the order of convergence: minus the slope of log(error) over log(N), by least squares.
double order_of(const std::vector<int>& samples, const std::vector<double>& errors) {
    double n = 0, x = 0, y = 0, xx = 0, xy = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const double lx = std::log(samples[i]), ly = std::log(errors[i]);
        n += 1, x += lx, y += ly, xx += lx * lx, xy += lx * ly;
    }
    return -(n * xy - x * y) / (n * xx - x * x);
}

TEST_F(SlicingTest, ErrorOfMidpointSamplesFallsAtSecondOrder) {
    const Volume volume = gaussians(64);
    for (const Projection projection : {Projection::orthographic, Projection::perspective}) {
        const Scene scene = unit_box_scene(smooth_transfer_function(), projection);
        const Image reference = trace(volume, scene, 1e-7);
        const std::vector<int> samples{32, 45, 64, 91, 128, 181, 256};
        std::vector<double> errors;
        for (const int n : samples) {
            errors.push_back(l2_against(reference, volume, scene, n, capabilities()));
        }
        // Midpoint rule on a continuous integrand with kinks: order 2. 1.7 leaves room for kinks
        // and for the silhouette.
        EXPECT_GE(order_of(samples, errors), 1.7);
        EXPECT_LT(errors.back(), .05);  // of 255, at 256 slabs
    }
}

TEST_F(SlicingTest, NarrowPeaksNeedFewerSlabsWithPreintegration) {
    const Volume volume = gaussians(64);
    Scene scene = unit_box_scene(
        TransferFunction::linear(
            {knot(.48, {.1, .5, 1}, 0), knot(.5, {1, .8, .2}, 40), knot(.52, {.9, .1, .1}, 0)}),
        Projection::perspective);
    const Image reference = trace(volume, scene, 1e-6);
    const double post = l2_against(reference, volume, scene, 512, capabilities());
    scene.slice.classification = Classification::preintegrated;
    const double preintegrated = l2_against(reference, volume, scene, 128, capabilities());
    EXPECT_LT(preintegrated, post);
    EXPECT_LT(preintegrated, .5);
}

// With two slabs a voxel and a transfer function that shows a smooth surface, the picture may be
// off by two codes of 8 bits in the worst pixel, and by a quarter of one in the root mean square;
// both when samples are fetched and when they are filtered.
TEST_P(BothEngines, TwoSlabsAVoxelMeetTheReference) {
    const Volume volume =
        generate({"marschner-lobb", std::array<std::int64_t, 3>{48, 48, 48}, SampleType::uint8});
    Scene scene = unit_box_scene(
        TransferFunction::linear({knot(0, {0, 0, 0}, 0), knot(100, {.1, .4, .8}, 0),
                                  knot(160, {.9, .6, .1}, 8), knot(255, {1, 1, .9}, 30)}),
        Projection::perspective);
    scene.slice.classification = Classification::preintegrated;
    const Image reference = trace(volume, scene, 1e-6);
    for (const Capabilities& can : ways()) {
        const ErrorNorms error = image_error(draw(volume, scene, {}, can), reference).all;
        EXPECT_LE(error.linf, 2);
        EXPECT_LE(error.l2, .25);
    }
}

// The texture unit's 8-bit weights are off by at most 1/256 of the difference between neighbouring
// samples on each axis. The difference from exact arithmetic must also be above 0: otherwise the
// filter would not be the hardware's.
TEST_P(BothEngines, HardwareFilterHasAnErrorOfItsOwn) {
    const Volume volume =
        generate({"marschner-lobb", std::array<std::int64_t, 3>{32, 32, 32}, SampleType::uint8});
    Scene scene =
        unit_box_scene(TransferFunction::linear({knot(0, {0, 0, 0}, 0), knot(255, {1, 1, 1}, 3)}),
                       Projection::orthographic);
    scene.slice.samples = 100;
    const Image exact = draw(volume, scene);
    scene.slice.filter = Filter::hardware;
    const double error = linf(draw(volume, scene), exact);
    // The scalar is off by at most 3/256 and, in OpenGL, half an 8-bit code, each of the range;
    // extinction by 3 times that, over a chord of at most sqrt(3); and opacity by no more than
    // optical depth.
    const double code = is_native() ? 0 : .5 / 255;
    EXPECT_LE(error, 255 * 3 * std::sqrt(3.) * (3. / 256 + code));
    EXPECT_GT(error, 0);
}

// Draws what is planned for a GPU with an 8-bit filter by software's 16-bit filter, which is no
// worse.
TEST_F(SlicingTest, TheHardwareFilterIsTakenWhereItsErrorIsSmall) {
    const Volume volume =
        generate({"gaussians", std::array<std::int64_t, 3>{32, 32, 32}, SampleType::uint16});
    Scene scene = unit_box_scene(
        TransferFunction::linear({knot(0, {.1, .2, .6}, 0), knot(65535, {1, .3, .1}, 6)}),
        Projection::perspective);
    scene.slice.filter = automatic;
    Capabilities gpu = capabilities();
    gpu.exact_float_filter = false;
    gpu.eight_bit_filter = true;
    const MinMaxBricks bricks = measure_bricks(volume);
    const Facts facts = measure(scene, volume, bricks);
    TableCache tables;
    const SampleTrials trials = try_samples(scene, volume, bricks, facts, gpu, false, tables);
    const Image traced = trace(volume, scene, 1e-7);
    const auto draw = [&](const Auto<Filter>& filter, VolumeSampling expected) {
        scene.slice.filter = filter;
        const Plan plan = make_plan(scene, facts, gpu, {}, trials);
        EXPECT_EQ(plan.slice.sampling, expected);
        GlSliceRenderer renderer(volume, *scene.transfer_function, facts, plan.slice, gpu,
                                 scene.width, scene.height);
        renderer.draw(View(*scene.camera, scene.width, scene.height));
        return renderer.read();
    };
    const Image filtered = draw(automatic, VolumeSampling::hardware);
    const Image fetched = draw(Filter::exact, VolumeSampling::fetch);
    EXPECT_LE(image_error(filtered, traced).all.linf, scene.max_error);
    EXPECT_LE(image_error(fetched, traced).all.linf, scene.max_error);

    gpu.eight_bit_filter = false;
    draw(automatic, VolumeSampling::fetch);
}

}  // namespace
}  // namespace lamina
