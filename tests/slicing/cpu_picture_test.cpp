// SPDX-License-Identifier: Apache-2.0
// Pictures of the cpu engine against OpenGL's in float32. Tests of BothEngines hold them against
// exact chords and against the tracer.
#include "engine_fixture.h"
#include "support/volume_of.h"

namespace lamina {
namespace {

INSTANTIATE_TEST_SUITE_P(Engines, BothEngines, testing::Values(cpu_engine, "osmesa"), engine_name);

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

}  // namespace
}  // namespace lamina
