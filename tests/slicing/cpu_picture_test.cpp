// SPDX-License-Identifier: Apache-2.0
// Pictures of the cpu engine against OpenGL's in float32, against exact chords and against the
// tracer.
#include "cpu_fixture.h"
#include "reference/chord.h"
#include "support/volume_of.h"

namespace lamina {
namespace {

Volume lobes(SampleType type) {
    return generate({"marschner-lobb", std::array<std::int64_t, 3>{37, 29, 33}, type});
}

// Returns a transfer function of `count` intervals over the volume's range.
TransferFunction hues(const Volume& volume, int count) {
    const ValueRange range = measure_bricks(volume).whole;
    std::vector<TransferKnot> knots;
    for (int i = 0; i <= count; ++i) {
        const double x = static_cast<double>(i) / count;
        knots.push_back(knot(range.lo + (range.hi - range.lo) * x,
                             {.5 + .5 * std::sin(7 * x), x, .5 + .5 * std::cos(11 * x)},
                             i < count / 4 ? 0.0 : 3 * x));
    }
    return TransferFunction::linear(knots);
}

// Positions are good to two units in the last place of float (here 6e-6 of a voxel), scalars change
// by less than half of their range in a voxel, and extinction by 3 over the range: so optical
// depths differ by at most 1e-5 in each picture.
TEST_F(SlicingTest, CpuShowsWhatOpenGlShows) {
    for (const SampleType type : {SampleType::uint8, SampleType::uint16, SampleType::float32}) {
        const Volume volume = lobes(type);
        for (const int intervals : {1, 5, 12, 60}) {
            Scene scene = unit_box_scene(hues(volume, intervals), Projection::perspective, 61, 47);
            scene.slice.samples = 90;
            for (const Classification classification :
                 {Classification::post, Classification::preintegrated}) {
                scene.slice.classification = classification;
                for (const OmissionSwitch& omissions : {OmissionSwitch{}, leave_nothing_out()}) {
                    EXPECT_LE(linf(render_tiles(volume, scene, omissions),
                                   render(volume, scene, capabilities(), omissions)),
                              255 * 2e-5)
                        << name_of(type) << " " << intervals << " " << name_of(classification)
                        << " " << omissions.none;
                }
            }
        }
    }
}

TEST_F(SlicingTest, CpuShowsWhatOpenGlShowsFromEverywhere) {
    const Volume volume = lobes(SampleType::uint8);
    for (const Projection projection : {Projection::orthographic, Projection::perspective}) {
        for (const glm::dvec3& eye :
             {glm::dvec3(1.7, -.9, 1.3), glm::dvec3(.31, .42, .63), glm::dvec3(.5, .5, 4)}) {
            Scene scene = unit_box_scene(hues(volume, 4), projection, 70, 50);
            scene.camera->eye = eye;
            scene.camera->center = {.52, .47, .51};
            scene.camera->fov_y = 70;
            scene.slice.samples = 77;
            for (const Order order : {Order::back_to_front, Order::front_to_back}) {
                scene.slice.order = order;
                EXPECT_LE(linf(render_tiles(volume, scene, leave_nothing_out()),
                               render(volume, scene, capabilities(), leave_nothing_out())),
                          255 * 2e-5);
            }
            EXPECT_LE(linf(render_tiles(volume, scene), render(volume, scene, capabilities())),
                      255 * 2e-5);
        }
    }
}

TEST(CpuPictureTest, HomogeneousBoxHasTheExactChordsOpacity) {
    const Volume volume =
        generate({"constant", std::array<std::int64_t, 3>{9, 12, 7}, SampleType::uint8});
    Scene scene = unit_box_scene(smooth_transfer_function(), Projection::perspective, 61, 47);
    scene.camera->center = {.52, .47, .51};
    scene.camera->up = {0, 1, .02};
    scene.camera->fov_y = 60;
    for (const auto& [projection, eye] :
         {std::pair{Projection::orthographic, glm::dvec3(1.7, -1.2, 1.4)},
          std::pair{Projection::perspective, glm::dvec3(1.21, -.17, 1.19)},
          std::pair{Projection::perspective, glm::dvec3(.31, .42, .63)}}) {
        scene.camera->projection = projection;
        scene.camera->eye = eye;
        const View view(*scene.camera, scene.width, scene.height);
        for (const double depth : {1e-4, .3, 30.}) {
            const double extinction = depth / std::sqrt(3.0);
            scene.transfer_function = TransferFunction::linear({knot(0, {1, 1, 1}, extinction)});
            for (const int samples : {1, 7, 256}) {
                for (const OmissionSwitch& omissions : {OmissionSwitch{}, leave_nothing_out()}) {
                    scene.slice.samples = samples;
                    const Image image = render_tiles(volume, scene, omissions);
                    double worst = 0;
                    for (int row = 0; row < view.height; ++row) {
                        for (int column = 0; column < view.width; ++column) {
                            const double chord = chord_length(volume.grid(), view, column, row);
                            worst = std::max(worst, std::abs(image.pixel(column, row)[3] +
                                                             std::expm1(-extinction * chord)));
                        }
                    }
                    EXPECT_LE(worst, chord_bound(depth)) << depth << " " << samples;
                }
            }
        }
    }
}

TEST(CpuPictureTest, ThinBoxesHaveTheExactChordsOpacity) {
    const Volume volume =
        generate({"constant", std::array<std::int64_t, 3>{40, 1, 40}, SampleType::uint8});
    Scene scene = unit_box_scene(TransferFunction::linear({knot(0, {1, 1, 1}, .3)}),
                                 Projection::perspective, 61, 47);
    scene.camera->eye = {.4, .506, 2.1};
    scene.camera->center = {.52, .47, .51};
    scene.camera->up = {0, 1, .02};
    scene.camera->fov_y = 30;
    scene.slice.samples = 40;
    const View view(*scene.camera, scene.width, scene.height);
    const Image image = render_tiles(volume, scene);
    for (int row = 0; row < view.height; ++row) {
        for (int column = 0; column < view.width; ++column) {
            EXPECT_NEAR(image.pixel(column, row)[3],
                        -std::expm1(-.3 * chord_length(volume.grid(), view, column, row)),
                        chord_bound(.3));
        }
    }
}

// Bounds: convergence_test.cpp.
TEST(CpuPictureTest, TwoSlabsAVoxelMeetTheReference) {
    const Volume volume =
        generate({"marschner-lobb", std::array<std::int64_t, 3>{48, 48, 48}, SampleType::uint8});
    Scene scene = unit_box_scene(
        TransferFunction::linear({knot(0, {0, 0, 0}, 0), knot(100, {.1, .4, .8}, 0),
                                  knot(160, {.9, .6, .1}, 8), knot(255, {1, 1, .9}, 30)}),
        Projection::perspective);
    scene.slice.classification = Classification::preintegrated;
    const ErrorNorms error =
        image_error(render_tiles(volume, scene), trace(volume, scene, 1e-6)).all;
    EXPECT_LE(error.linf, 2);
    EXPECT_LE(error.l2, .25);
}

// Bound and reason: convergence_test.cpp.
TEST(CpuPictureTest, HardwareFilterHasAnErrorOfItsOwn) {
    const Volume volume =
        generate({"marschner-lobb", std::array<std::int64_t, 3>{32, 32, 32}, SampleType::uint8});
    Scene scene =
        unit_box_scene(TransferFunction::linear({knot(0, {0, 0, 0}, 0), knot(255, {1, 1, 1}, 3)}),
                       Projection::orthographic);
    scene.slice.samples = 100;
    const Image exact = render_tiles(volume, scene);
    scene.slice.filter = Filter::hardware;
    const double error = linf(render_tiles(volume, scene), exact);
    EXPECT_LE(error, 255 * 3 * std::sqrt(3.) * (3. / 256));
    EXPECT_GT(error, 0);
}

TEST(CpuPictureTest, NanCellsAreTransparentIfAskedFor) {
    Grid grid = reference_test::make_grid({12, 12, 12}, Centering::node, glm::dvec3(1. / 11));
    std::vector<float> samples(12 * 12 * 12);
    for (std::size_t i = 0; i < samples.size(); ++i) samples[i] = static_cast<float>(i % 12) / 11;
    samples[6 * 144 + 6 * 12 + 6] = NAN;
    samples[3 * 144 + 8 * 12 + 2] = INFINITY;
    const Volume volume = reference_test::make_volume(grid, samples);
    Scene scene = unit_box_scene(smooth_transfer_function(), Projection::perspective);
    scene.nan = NanPolicy::transparent;
    scene.slice.samples = 800;
    const Image reference = trace(volume, scene, 1e-6);
    for (const Classification classification :
         {Classification::post, Classification::preintegrated}) {
        scene.slice.classification = classification;
        // targets_test.cpp
        EXPECT_LE(linf(render_tiles(volume, scene), reference), 255 * 6 * 4 * 1.8 / 800);
    }
}

TEST(CpuPictureTest, EmptySpaceIsLeftOutBitForBit) {
    const Volume volume = gaussians(64);
    const TransferFunction top = TransferFunction::linear(
        {knot(.8, {.1, .5, .9}, 0), knot(.9, {.9, .5, .1}, 20), knot(1, {1, 1, 1}, 30)});
    for (const Classification classification :
         {Classification::post, Classification::preintegrated}) {
        for (const Projection projection : {Projection::orthographic, Projection::perspective}) {
            Scene scene = unit_box_scene(top, projection);
            scene.slice.classification = classification;
            scene.slice.samples = 137;
            OmissionSwitch only_that;
            only_that.kept = {"empty_space"};
            EXPECT_EQ(linf(render_tiles(volume, scene), render_tiles(volume, scene, only_that)), 0);
        }
    }
}

// Whole numbers stored as bytes and as words give the same picture, with and without a second
// sample along x, because samples are fetched in a different way if there is none.
TEST(CpuPictureTest, BytesAndWordsGiveThePictureBitForBit) {
    for (const std::array<std::int64_t, 3> size :
         {std::array<std::int64_t, 3>{37, 29, 33}, {1, 29, 33}, {37, 1, 33}, {2, 3, 1}}) {
        const Volume bytes = generate({"mixing", size, SampleType::uint8});
        const auto* const samples = static_cast<const std::uint8_t*>(bytes.data());
        const Volume words =
            test::volume_of<std::uint16_t>(bytes.grid(), [&](double i, double j, double k) {
                const double index =
                    (k * static_cast<double>(size[1]) + j) * static_cast<double>(size[0]) + i;
                return samples[static_cast<std::size_t>(index)];
            });
        for (const Classification classification :
             {Classification::post, Classification::preintegrated, Classification::exact}) {
            Scene scene = unit_box_scene(hues(bytes, 3), Projection::perspective, 61, 47);
            scene.slice.samples = 50;
            scene.slice.classification = classification;
            EXPECT_EQ(render_tiles(bytes, scene).rgba, render_tiles(words, scene).rgba);
        }
    }
}

// Bounds and reasons: bricks_test.cpp.
TEST(CpuPictureTest, BricksLeaveNoSeam) {
    const Volume volume = gaussians(40);
    Capabilities small = cpu_capabilities();
    small.max_texture_bytes = 16 * 64 * 48 + 4 * 1000;
    for (const Classification classification :
         {Classification::post, Classification::preintegrated}) {
        for (const bool blending : {false, true}) {
            for (const Order order : {Order::back_to_front, Order::front_to_back}) {
                Scene scene = unit_box_scene(smooth_transfer_function(), Projection::perspective);
                scene.slice.samples = 200;
                scene.slice.classification = classification;
                scene.slice.order = order;
                OmissionSwitch omissions;
                if (blending) omissions.kept = {"blending"};
                EXPECT_LE(linf(render_tiles(volume, scene, omissions),
                               render_tiles(volume, scene, omissions, small)),
                          .2);
            }
        }
    }
}

// labels_test.cpp
TEST(CpuPictureTest, StepsAtLabelsShowTheirLaterSide) {
    constexpr int labels = 7, slabs = 2048;
    constexpr double extinction = .3;
    const Volume volume = test::volume_of<std::uint8_t>(
        test::grid_of({2 * labels, 8, 8}, Centering::node),
        [](double i, double, double) { return 3 * std::floor(i / 2); });
    std::vector<TransferKnot> points{knot(0, {1, 0, 0}, .02)};
    for (int label = 1; label < labels; ++label) {
        const double value = 3 * label;
        points.push_back(knot(value, points.back().optics.color, points.back().optics.extinction));
        points.push_back(knot(value, {label % 2, .5, 1. / label}, label % 2 ? extinction : .05));
    }
    Scene scene = unit_box_scene(TransferFunction::linear(points), Projection::perspective);
    scene.camera->eye = {20, 15, 18};
    scene.camera->center = {6.5, 3.5, 3.5};
    scene.slice.samples = slabs;
    const double longest = 2 * std::hypot(13, 7, 7);
    const Image reference = trace(volume, scene, 1e-6);
    for (const auto classification : {Classification::post, Classification::preintegrated}) {
        scene.slice.classification = classification;
        EXPECT_LT(linf(render_tiles(volume, scene), reference),
                  255 * 2 * labels * extinction * longest / slabs);
    }
}

}  // namespace
}  // namespace lamina
