// SPDX-License-Identifier: Apache-2.0
// Pictures without one remedy have its artifact (Kraus 2004, section 5), and variants agree if they
// must.
#include "projection_fixture.h"
#include "support/split_box.h"

namespace lamina {
namespace {

TransferFunction smooth() {
    return TransferFunction::linear(
        {knot(0, {.1, .2, .9}, .05), knot(.5, {.2, .9, .3}, .3), knot(1, {.9, .3, .1}, .6)});
}

class Variants : public ProjectionTest {
  protected:
    Variants() : mesh_(scene_mesh(test::split_box(11, 3000, 1e-2, ripples))) {}

    Scene scene(const TransferFunction& transfer_function = smooth()) const {
        Scene scene = projection_scene(transfer_function, 96, 96);
        scene.camera->eye = {1.4, -.5, 1.3};
        scene.camera->center = {.5, .5, .5};
        scene.camera->fov_y = 60;
        return scene;
    }
    double l2(const Scene& scene) const {
        return image_error(project(mesh_, scene, capabilities()), trace(mesh_, scene)).all.l2;
    }

    SceneMesh mesh_;
};

// The bound is the weights' error, .005 / 255, times the change of colour along a ray, which is
// some twice that from blue to red; opacities are good to float32's rounding.
TEST_P(Variants, DefaultIsExact) {
    Scene wanted = scene();
    const ErrorNorms error =
        image_error(project(mesh_, wanted, capabilities()), trace(mesh_, wanted)).all;
    EXPECT_LE(error.linf, 0.05);
    EXPECT_LE(error.l2, 0.01);
}

TEST_P(Variants, AnalyticIsExact) {
    Scene wanted = scene();
    wanted.project.coloring = Coloring::analytic;
    // The error is 3e-6 a tet (shaders/optics/piece_weights.glsl), of which a ray meets a hundred:
    // .08 / 255 at most.
    EXPECT_LE(l2(wanted), 0.02);
}

TEST_P(Variants, LinearInterpolationIsWorse) {
    Scene linear = scene();
    linear.project.interpolation = Interpolation::linear;
    EXPECT_GT(l2(linear), 5 * l2(scene()));
}

TEST_P(Variants, ThicknessFromDepthsIsWorse) {
    Scene dz = scene();
    dz.project.thickness = Thickness::dz;
    EXPECT_GT(l2(dz), 5 * l2(scene()));
}

TEST_P(Variants, EightBitTableIsWorse) {
    Scene fixed16 = scene();
    fixed16.project.table = TableSettings{.store = TableStore::opacity};
    Scene fixed8 = fixed16;
    fixed8.project.table->format = TableFormat::fixed8;
    EXPECT_GT(l2(fixed8), l2(fixed16));
}

TEST_P(Variants, EightBitTargetIsWorseThanDitheredThanFloat) {
    // The total opacity is below .5, as in the paper's pictures: dense ones hide errors in what
    // lies behind.
    Scene exact = scene(TransferFunction::linear(
        {knot(0, {.1, .2, .9}, .02), knot(.5, {.2, .9, .3}, .1), knot(1, {.9, .3, .1}, .2)}));
    Scene fixed8 = exact;
    fixed8.target = Target::fixed8;
    Scene dithered = fixed8;
    dithered.project.dither = ProjectDither::alpha;
    Scene after = fixed8;
    after.project.dither = ProjectDither::after_blend;
    EXPECT_GT(l2(fixed8), l2(dithered));
    EXPECT_GT(l2(dithered), l2(exact));
    EXPECT_GT(l2(fixed8), l2(after));
}

// Steps and narrow peaks are exact if tets are cut at the transfer function's points; vertex and
// mean colouring are coarse.
TEST_P(Variants, PeaksAreExactInParts) {
    Scene peak = scene(TransferFunction::linear(
        {knot(.48, {1, 1, 1}, 0), knot(.5, {1, .8, .2}, 200), knot(.52, {1, .2, .1}, 0),
         knot(.7, {0, .2, 1}, 0), knot(.7, {0, .2, 1}, 4)}));
    // Weights of opaque peaks are off by up to .13 / 255, cuts of tets by float32's rounding.
    EXPECT_LE(image_error(project(mesh_, peak, capabilities()), trace(mesh_, peak)).all.linf, 0.5);
    const double exact = l2(peak);
    for (const Coloring coloring : {Coloring::vertex, Coloring::attenuation}) {
        Scene coarse = peak;
        coarse.project.coloring = coloring;
        EXPECT_GT(l2(coarse), 10 * exact);
    }
}

// Stochastic rounding after the blend has no bias: N tets a pixel, each off by at most one code
// with mean 0, average out over 96 * 96 pixels * 4 channels.
TEST_P(Variants, AfterBlendIsUnbiased) {
    Scene after = scene();
    after.target = Target::fixed8;
    after.project.dither = ProjectDither::after_blend;
    const ErrorNorms error =
        image_error(project(mesh_, after, capabilities()), trace(mesh_, after)).all;
    EXPECT_LE(std::abs(error.mean), 0.3);
}

// Omissions change the picture by no more than float32's rounding of some hundred OVERs and
// lengths: 100 * 1.2e-7 * 255 = .003.
TEST_P(Variants, OmissionsKeepThePicture) {
    OmissionSwitch nothing;
    nothing.none = true;
    for (const auto& transfer_function :
         {smooth(), TransferFunction::linear({knot(0, {1, .5, 0}, 1)}),
          TransferFunction::linear({knot(.6, {1, .5, 0}, 0), knot(.8, {1, .5, 0}, 3)})}) {
        for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
            Scene wanted = scene(transfer_function);
            wanted.camera->projection = projection;
            const Image less = project(mesh_, wanted, capabilities());
            const Image all = project(mesh_, wanted, capabilities(), nothing);
            EXPECT_LE(image_error(less, all).all.linf, 0.01);
        }
    }
}

// Native blending rounds alpha to nearest and fuses (docs/numerics.md, section 2, llvmpipe). But it
// gets associated colours, which are rounded once more: by less than a code of 65535 at each of
// some hundred tets.
TEST_P(Variants, EmulatedAgreesWithFixed16) {
    Scene native = scene();
    native.target = Target::fixed16;
    Scene emulated = scene();
    emulated.target = Target::emulated;
    emulated.emulate = {16, AlphaRounding::nearest, OverRounding::fused, 1};
    EXPECT_LE(image_error(project(mesh_, native, capabilities()),
                          project(mesh_, emulated, capabilities()))
                  .all.linf,
              0.5);
}

INSTANTIATE_TEST_SUITE_P(Engines, Variants, every_engine, engine_name);

}  // namespace
}  // namespace lamina
