// SPDX-License-Identifier: Apache-2.0
// A homogeneous box has the opacity that follows from the exact length of the ray's chord, for any
// number of slabs and any angle.
#include "engine_fixture.h"
#include "reference/chord.h"
#include "volume/generate.h"

namespace lamina {
namespace {

struct Pose {
    const char* name;
    Projection projection;
    glm::dvec3 eye;
    double fov_y;
};

const Pose poses[] = {
    {"orthographic along an axis", Projection::orthographic, {.5, .5, 3}, 0},
    {"orthographic oblique", Projection::orthographic, {1.7, -1.2, 1.4}, 0},
    {"perspective, 1.2 box lengths away", Projection::perspective, {1.21, -.17, 1.19}, 60},
    {"perspective, eye inside", Projection::perspective, {.31, .42, .63}, 60},
    {"perspective, eye inside, wide", Projection::perspective, {.05, .93, .5}, 150},
};

double longest_chord(const Grid& grid, const View& view) {
    double longest = 0;
    for (int row = 0; row < view.height; ++row) {
        for (int column = 0; column < view.width; ++column) {
            longest = std::max(longest, chord_length(grid, view, column, row));
        }
    }
    return longest;
}

// `draw`: draws a scene of the volume.
void expect_exact_chords(const Volume& volume, const Pose& pose,
                         const std::function<Image(const Scene&)>& draw) {
    Scene scene = unit_box_scene(smooth_transfer_function(), pose.projection, 61, 47);
    scene.camera->eye = pose.eye;
    scene.camera->fov_y = pose.fov_y;
    scene.camera->center = {.52, .47, .51};
    scene.camera->up = {0, 1, .02};
    const View view(*scene.camera, scene.width, scene.height);
    const double longest = longest_chord(volume.grid(), view);
    ASSERT_GT(longest, .5);
    for (const double depth : {1e-4, .01, .3, 3., 30.}) {
        const double extinction = depth / longest;
        scene.transfer_function = TransferFunction::linear({knot(0, {1, 1, 1}, extinction)});
        for (const int samples : {1, 7, 256}) {
            for (const Order order : {Order::back_to_front, Order::front_to_back}) {
                scene.slice.samples = samples;
                scene.slice.order = order;
                const Image image = draw(scene);
                double worst = 0;
                for (int row = 0; row < view.height; ++row) {
                    for (int column = 0; column < view.width; ++column) {
                        const double chord = chord_length(volume.grid(), view, column, row);
                        const double alpha = image.pixel(column, row)[3];
                        worst = std::max(worst, std::abs(alpha + std::expm1(-extinction * chord)));
                    }
                }
                EXPECT_LE(worst, chord_bound(depth)) << pose.name << ", depth " << depth << ", "
                                                     << samples << " slabs, " << name_of(order);
            }
        }
    }
}

TEST_P(BothEngines, HomogeneousBoxHasTheExactChordsOpacity) {
    const Volume volume =
        generate({"constant", std::array<std::int64_t, 3>{9, 12, 7}, SampleType::uint8});
    for (const Pose& pose : poses)
        expect_exact_chords(volume, pose, [&](const Scene& scene) { return draw(volume, scene); });
}

TEST_P(BothEngines, HomogeneousBoxIsExactWithNothingLeftOut) {
    const Volume volume =
        generate({"constant", std::array<std::int64_t, 3>{9, 12, 7}, SampleType::uint8});
    for (const Pose& pose : {poses[1], poses[2]}) {
        expect_exact_chords(volume, pose, [&](const Scene& scene) {
            return draw(volume, scene, leave_nothing_out());
        });
    }
}

// A box one voxel thick, seen nearly edge-on: float32 coordinates of all of the box would lose its
// chords.
TEST_P(BothEngines, ThinBoxesHaveTheExactChordsOpacity) {
    const Volume volume =
        generate({"constant", std::array<std::int64_t, 3>{40, 1, 40}, SampleType::uint8});
    for (const double tilt : {.003, .05}) {
        for (const auto projection : {Projection::orthographic, Projection::perspective}) {
            const Pose pose{"thin", projection, {.4, .5 + 2 * tilt, 2.1}, 30};
            expect_exact_chords(volume, pose,
                                [&](const Scene& scene) { return draw(volume, scene); });
        }
    }
}

TEST_F(SlicingTest, EveryClassificationGivesTheSameHomogeneousBox) {
    const Volume volume =
        generate({"constant", std::array<std::int64_t, 3>{8, 8, 8}, SampleType::uint8});
    Scene scene = unit_box_scene(TransferFunction::linear({knot(0, {.3, .6, .9}, 2)}),
                                 Projection::perspective);
    scene.slice.samples = 20;
    const Image post = render(volume, scene, capabilities(), leave_nothing_out());
    scene.slice.classification = Classification::preintegrated;
    const Image preintegrated = render(volume, scene, capabilities(), leave_nothing_out());
    // A table entry is rounded to float32 (6e-8 relative), and multiplied by optical depths of at
    // most 3.5.
    EXPECT_LE(image_error(post, preintegrated).all.linf, 255 * 1e-6);
}

}  // namespace
}  // namespace lamina
