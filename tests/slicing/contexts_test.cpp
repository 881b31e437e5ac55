// SPDX-License-Identifier: Apache-2.0
// A context gives the same picture twice; another context gives nearly the same.
#include "slicing_fixture.h"

namespace lamina {
namespace {

Image render_in(gl::ContextKind kind, const Volume& volume, const Scene& scene) {
    const auto context = gl::Context::create(kind);
    const gl::CurrentContext current(*context);
    return render(volume, scene, context->capabilities());
}

Scene scene_for(Classification classification) {
    Scene scene = unit_box_scene(smooth_transfer_function(), Projection::perspective);
    scene.slice.samples = 90;
    scene.slice.classification = classification;
    return scene;
}

TEST(SlicingContexts, OsmesaRepeatsItselfBitForBit) {
    const Volume volume = gaussians(32);
    for (const Classification classification :
         {Classification::post, Classification::preintegrated}) {
        const Scene scene = scene_for(classification);
        const Image first = render_in(gl::ContextKind::osmesa, volume, scene);
        EXPECT_EQ(first.rgba, render_in(gl::ContextKind::osmesa, volume, scene).rgba);
    }
}

TEST(SlicingContexts, EglAgreesWithOsmesa) {
    if (!gl::has_egl()) GTEST_SKIP() << "no libEGL.so.1";
    const Volume volume = gaussians(32);
    for (const Classification classification :
         {Classification::post, Classification::preintegrated}) {
        const Scene scene = scene_for(classification);
        const Image osmesa = render_in(gl::ContextKind::osmesa, volume, scene);
        // Drivers round differently: 90 slabs with some ten roundings of 6e-8 each are 5e-5 of full
        // scale.
        EXPECT_LE(image_error(osmesa, render_in(gl::ContextKind::egl, volume, scene)).all.linf,
                  255 * 1e-4);
    }
}

}  // namespace
}  // namespace lamina
