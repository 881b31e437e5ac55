// SPDX-License-Identifier: Apache-2.0
// Lit scenes in studies.
#include <gtest/gtest.h>

#include "image/difference.h"
#include "study/data_store.h"
#include "study/study_frames.h"
#include "support/transfer_functions.h"
#include "tiles/cpu_capabilities.h"

namespace lamina::study {
namespace {

Scene lit_scene() {
    Scene scene;
    scene.volume =
        GeneratorRequest{"gaussians", std::array<std::int64_t, 3>{12, 12, 12}, SampleType::float32};
    scene.transfer_function = test::smooth();
    scene.camera->eye = {1.7, -.9, 1.3};
    scene.camera->center = {.5, .5, .5};
    scene.width = 24;
    scene.height = 18;
    scene.slice.classification = Classification::exact;
    scene.lighting = Lighting{};
    return scene;
}

// The smallest gradient is chosen from the data once, for the picture and for its reference.
TEST(LitStudy, ChoosesTheSmallestGradientAndTracesWithLight) {
    DataStore data;
    StudyFrames frames(lit_scene(), data, cpu_capabilities(), std::make_shared<TableCache>());
    ASSERT_TRUE((*frames.scene().lighting)->smallest_gradient.is_given());
    // .01 of the range of values, which is at most 1, over the distance of samples.
    EXPECT_GT(*(*frames.scene().lighting)->smallest_gradient, .005 * 11);
    EXPECT_LE(*(*frames.scene().lighting)->smallest_gradient, .01 * 12);
    ReferenceStore references;
    const Reference& reference = references.get(frames.scene(), TraceOf::volume, data);
    EXPECT_LE(image_error(frames.picture(), reference.image).all.linf, frames.scene().max_error);
    Scene unlit = frames.scene();
    unlit.lighting.reset();
    const Reference& other = references.get(unlit, TraceOf::volume, data);
    EXPECT_GT(image_error(frames.picture(), other.image).all.linf, 5);
}

TEST(LitStudy, PicturesOfOtherLightsHaveOtherKeys) {
    const Scene scene = lit_scene();
    std::vector<Scene> others(6, scene);
    others[0].lighting.reset();
    (*others[1].lighting)->ambient = .2;
    (*others[2].lighting)->power = 11;
    (*others[3].lighting)->smallest_gradient = .1;
    (*others[4].lighting)->lights[0].direction = glm::dvec3(0, 0, 1);
    (*others[5].lighting)->lights.push_back({});
    for (const Scene& other : others) EXPECT_NE(picture_key(other), picture_key(scene));
}

}  // namespace
}  // namespace lamina::study
