// SPDX-License-Identifier: Apache-2.0
#include "slicing/slab_trials.h"

#include "plan/choices.h"
#include "slicing/slice_renderer.h"
#include "slicing_fixture.h"
#include "tiles/cpu_capabilities.h"
#include "volume/generate.h"

namespace lamina {
namespace {

Volume mixing(std::int64_t edge) {
    return generate({"mixing", std::array{edge, edge, edge}, SampleType::float32});
}

struct Tried {
    Facts facts;
    SampleTrials trials;
    SlabTrial chosen() const { return chosen_slabs(facts, trials); }
};

Tried try_slabs(const Scene& scene, const Volume& volume,
                const Capabilities& capabilities = cpu_capabilities(), bool many_frames = false) {
    const MinMaxBricks bricks = measure_bricks(volume);
    Tried tried{measure(scene, volume, bricks), {}};
    TableCache tables;
    tried.trials =
        try_samples(scene, volume, bricks, tried.facts, capabilities, many_frames, tables);
    return tried;
}

Image draw(const Volume& volume, const Scene& scene, const Tried& tried) {
    const Plan plan = make_plan(scene, tried.facts, cpu_capabilities(), {}, tried.trials);
    const auto renderer =
        make_slice_renderer(volume, *scene.transfer_function, tried.facts, plan.slice,
                            cpu_capabilities(), scene.width, scene.height);
    renderer->draw(View(*scene.camera, scene.width, scene.height));
    return renderer->read();
}

Tried try_for_many_frames(const Scene& scene, const Volume& volume) {
    return try_slabs(scene, volume, cpu_capabilities(), true);
}

Classification classification_of(const Scene& scene, const Tried& tried) {
    return make_plan(scene, tried.facts, cpu_capabilities(), {}, tried.trials).slice.classification;
}

// For many frames, each of which should be quick, slabs are drawn if few of them keep the error.
TEST(SlabTrials, ManyFramesOfSmoothPicturesTakeFewSlabs) {
    const Volume volume = gaussians(48);
    Scene scene = unit_box_scene(smooth_transfer_function(), Projection::perspective);
    scene.slice = {};
    EXPECT_TRUE(try_slabs(scene, volume).trials.exact.empty());
    const Tried tried = try_for_many_frames(scene, volume);
    EXPECT_EQ(classification_of(scene, tried), Classification::post);
    EXPECT_LE(tried.chosen().slabs, slabs_per_voxel(tried.facts, quicker_slabs_per_voxel));
    const Image traced = trace(volume, scene, 1e-7);
    EXPECT_LE(image_error(draw(volume, scene, tried), traced).all.linf, scene.max_error);
}

TEST(SlabTrials, ManyFramesKeepExactSegmentsIfFewSlabsDoNotSuffice) {
    const Volume volume = gaussians(48);
    const TransferFunction peak = TransferFunction::linear(
        {knot(.5, {1, 1, 1}, 0), knot(.501, {1, .5, 0}, 200), knot(.502, {0, 0, 1}, 0)});
    Scene scene = unit_box_scene(peak, Projection::perspective);
    scene.slice = {};
    const Tried tried = try_for_many_frames(scene, volume);
    EXPECT_TRUE(tried.trials.exact.empty());
    EXPECT_EQ(classification_of(scene, tried), Classification::exact);
}

// Nothing is tried if the error grows with the number of slabs, or if the scene gives their number.
TEST(SlabTrials, ManyFramesTryNothingWhereSlabsAreGivenOrRounded) {
    const Volume volume = gaussians(24);
    Scene open = unit_box_scene(smooth_transfer_function(), Projection::perspective);
    open.slice = {};
    const auto expect_exact = [&](const Scene& scene) {
        const Tried tried = try_for_many_frames(scene, volume);
        EXPECT_TRUE(tried.trials.exact.empty());
        EXPECT_EQ(classification_of(scene, tried), Classification::exact);
    };
    Scene scene = open;
    scene.slice.samples = 64;
    expect_exact(scene);
    scene = open;
    scene.target = Target::fixed8;
    expect_exact(scene);
    scene = open;
    scene.slice.tree = TreeSettings{.factors = {8, 8}};
    expect_exact(scene);
}

// Pictures with the number of slabs that the trials choose keep max_error. Those with half as many
// do not: their error is some four times as large, because both rules are of second order.
TEST(SlabTrials, KeepTheErrorWithFewSlabs) {
    for (const Volume& volume : {gaussians(32), mixing(24)}) {
        for (const Classification classification :
             {Classification::post, Classification::preintegrated}) {
            Scene scene = unit_box_scene(smooth_transfer_function(), Projection::perspective);
            scene.slice.classification = classification;
            const Image traced = trace(volume, scene, 1e-7);
            for (const double max_error : {.25, 1., 4.}) {
                scene.max_error = max_error;
                scene.slice.samples = automatic;
                const Tried tried = try_slabs(scene, volume);
                const SlabTrial chosen = tried.chosen();
                EXPECT_LE(chosen.error, max_error);
                EXPECT_EQ(chosen.rays, 64 * 48);
                EXPECT_LE(image_error(draw(volume, scene, tried), traced).all.linf, max_error)
                    << chosen.slabs << " slabs";
                scene.slice.samples = chosen.slabs / 2;
                EXPECT_GT(image_error(draw(volume, scene, tried), traced).all.linf, max_error)
                    << chosen.slabs << " slabs";
            }
        }
    }
}

// The picture has more rays than are tried at first; the error is kept on all of them, also if the
// volume has kinks.
TEST(SlabTrials, KeepTheErrorOfAllRays) {
    for (const Volume& volume : {gaussians(16), mixing(16)}) {
        Scene scene = unit_box_scene(smooth_transfer_function(), Projection::perspective, 480, 360);
        const Tried tried = try_slabs(scene, volume);
        EXPECT_EQ(tried.chosen().rays, 480 * 360);
        EXPECT_LE(image_error(draw(volume, scene, tried), trace(volume, scene, 1e-6)).all.linf,
                  scene.max_error);
    }
}

// If the picture has very many rays, some 2^20 are tried, with a smaller goal that allows for the
// rest.
TEST(SlabTrials, TryNoMoreRaysThanAMillion) {
    const Volume volume = gaussians(8);
    const Scene scene =
        unit_box_scene(smooth_transfer_function(), Projection::perspective, 2400, 1800);
    const SlabTrial chosen = try_slabs(scene, volume).chosen();
    EXPECT_NEAR(static_cast<double>(chosen.rays), 1 << 20, .01 * (1 << 20));
    EXPECT_TRUE(chosen.keeps_goal());
    EXPECT_LT(chosen.goal, .75 * scene.max_error);
}

TEST(SlabTrials, AreMadeOnlyIfTheNumberOfSlabsMatters) {
    const Volume volume = gaussians(8);
    Scene scene = unit_box_scene(smooth_transfer_function(), Projection::orthographic);
    scene.slice.samples = 9;
    EXPECT_TRUE(try_slabs(scene, volume).trials.exact.empty());
    scene.slice.samples = automatic;
    EXPECT_FALSE(try_slabs(scene, volume).trials.exact.empty());
    scene.method = Method::trace;
    EXPECT_TRUE(try_slabs(scene, volume).trials.exact.empty());
    scene.method = Method::slice;
    scene.transfer_function = TransferFunction::linear({knot(0, {1, 1, 1}, 0)});
    EXPECT_TRUE(try_slabs(scene, volume).trials.exact.empty());
}

// With one extinction and colour every number of slabs gives the same picture.
TEST(SlabTrials, TakeOneSlabForAConstant) {
    const Volume volume = gaussians(8);
    Scene scene = unit_box_scene(TransferFunction::linear({knot(0, {.2, .4, .8}, 2)}),
                                 Projection::perspective);
    const Tried tried = try_slabs(scene, volume);
    EXPECT_EQ(tried.chosen().slabs, 1);
}

// An opaque step, whose silhouette moves with the slabs for any number of them.
TEST(SlabTrials, KnowThatAnErrorCannotBeKept) {
    const Volume volume = mixing(16);
    Scene scene = unit_box_scene(
        TransferFunction::linear({knot(0, {1, 1, 1}, 0), knot(.7, {1, 1, 1}, 0),
                                  knot(.7, {1, .5, 0}, 1e6), knot(1, {1, .5, 0}, 1e6)}),
        Projection::perspective, 160, 120);
    scene.max_error = .01;
    const Tried tried = try_slabs(scene, volume);
    const SlabTrial chosen = tried.chosen();
    EXPECT_GT(chosen.error, scene.max_error);
    // The diagonal of 15 cells is 26 voxels; more than a few slabs a voxel would not help.
    EXPECT_LE(chosen.slabs, 4 * 26);
}

// Expects that the claimed error is that of the picture itself; the picture is so small that every
// ray is traced.
void expect_claim_kept(const Volume& volume, const Scene& scene, const char* name) {
    const Tried tried = try_slabs(scene, volume);
    const SlabTrial chosen = tried.chosen();
    const double found =
        image_error(draw(volume, scene, tried), trace(volume, scene, 1e-7)).all.linf;
    EXPECT_EQ(chosen.traced, scene.width * scene.height) << name;
    // The pictures differ only by early termination and the tracer's tolerance of 4e-5, .01 / 255
    // each at most, and by rounding to float.
    EXPECT_NEAR(found, chosen.error, .03) << name << ", " << chosen.slabs << " slabs";
}

// The peak lies between the values that N and 3 N slabs sample, for any N.
TEST(SlabTrials, NarrowPeaksAreNotMissedByAllPictures) {
    const Volume ramp =
        generate({"ramp", std::array<std::int64_t, 3>{256, 4, 1}, SampleType::uint8});
    Scene scene;
    scene.slice.classification = Classification::post;
    scene.width = 64;
    scene.height = 48;
    scene.transfer_function =
        TransferFunction::linear({knot(100, {1, 1, 1}, 0), knot(100.1, {1, 1, 1}, 0),
                                  knot(100.2, {1, 1, 1}, 1e4), knot(100.3, {1, 1, 1}, 0)});
    scene.camera->projection = Projection::orthographic;
    scene.camera->eye = {-10, 1.5, 0};
    scene.camera->center = {128, 1.5, 0};
    scene.camera->height = 4;
    for (const Classification classification :
         {Classification::post, Classification::preintegrated}) {
        scene.slice.classification = classification;
        expect_claim_kept(ramp, scene, "ramp");
    }
}

// Sixty bright voxels among zeros: most rays meet none, and slabs step over the thin shells in
// which the peak lies.
TEST(SlabTrials, SmallThingsAreNotMissedByAllPictures) {
    reference_test::Random random(7);
    const Grid grid = reference_test::make_grid({64, 64, 64}, Centering::node, glm::dvec3(1. / 63));
    std::vector<float> samples(64 * 64 * 64, 0.F);
    for (int i = 0; i < 60; ++i)
        samples[static_cast<std::size_t>(random.below(64 * 64 * 64))] =
            static_cast<float>(random.uniform(.5, 1));
    const Volume volume = reference_test::make_volume(grid, samples);
    Scene scene = unit_box_scene(
        TransferFunction::linear(
            {knot(.4, {1, 1, 1}, 0), knot(.41, {1, .8, .2}, 2000), knot(.42, {1, 1, 1}, 0)}),
        Projection::perspective, 160, 120);
    expect_claim_kept(volume, scene, "sparse");
}

TEST(SlabTrials, ThinSilhouettesOfLabelsAreNotMissedByAllPictures) {
    const Volume volume = mixing(16);
    Scene scene = unit_box_scene(
        TransferFunction::linear({knot(0, {1, 1, 1}, 0), knot(.4, {1, 1, 1}, 0),
                                  knot(.4, {1, 0, 0}, 1e5), knot(.6, {1, 0, 0}, 1e5),
                                  knot(.6, {0, 0, 1}, 1e5), knot(1, {0, 0, 1}, 1e5)}),
        Projection::perspective, 160, 120);
    expect_claim_kept(volume, scene, "labels");
}

// In a larger picture not all rays are traced, but edges are, and some rays all over it.
TEST(SlabTrials, TraceOnlySomeRaysOfLargePictures) {
    const Volume volume = mixing(16);
    Scene scene = unit_box_scene(smooth_transfer_function(), Projection::perspective, 480, 360);
    const SlabTrial chosen = try_slabs(scene, volume).chosen();
    EXPECT_EQ(chosen.rays, 480 * 360);
    EXPECT_LE(chosen.traced, 12288);
    EXPECT_GE(chosen.traced, 12288 / 2);
}

Capabilities gpu() {
    Capabilities capabilities = cpu_capabilities();
    capabilities.cpu = false;
    capabilities.eight_bit_filter = true;
    return capabilities;
}

Tried measure_filter(const Scene& scene, const Volume& volume) {
    return try_slabs(scene, volume, gpu());
}

// The cpu engine draws with 8-bit weights, in the number of slabs that the trials choose: if that
// is automatic, all errors together keep the bound, else the error of the weights is measured.
TEST(SlabTrials, TheHardwareFilterKeepsTheErrorItClaims) {
    for (const Volume& volume : {gaussians(32), mixing(24)}) {
        Scene scene = unit_box_scene(smooth_transfer_function(), Projection::perspective);
        scene.slice.filter = automatic;
        const Image traced = trace(volume, scene, 1e-7);
        const Tried tried = measure_filter(scene, volume);
        const SlabTrial trial = slabs_of_hardware_filter(tried.trials).value();
        EXPECT_TRUE(trial.keeps_goal());
        Scene given = scene;
        given.slice.samples = trial.slabs;
        given.slice.filter = Filter::hardware;
        const Image filtered = draw(volume, given, tried);
        EXPECT_LE(image_error(filtered, traced).all.linf, scene.max_error);

        given.slice.filter = automatic;
        const Tried with_slabs = measure_filter(given, volume);
        given.slice.filter = Filter::exact;
        EXPECT_DOUBLE_EQ(with_slabs.trials.hardware.at(0).error,
                         image_error(filtered, draw(volume, given, tried)).all.linf);
        EXPECT_GT(with_slabs.trials.hardware.at(0).error, 0);
    }
}

TEST(SlabTrials, TheHardwareFilterIsNotTakenWhereItsErrorIsTooLarge) {
    const Volume volume = mixing(24);
    Scene scene = unit_box_scene(smooth_transfer_function(), Projection::perspective);
    scene.slice.filter = automatic;
    scene.slice.samples = 200;
    const auto trial = [&](double max_error) {
        scene.max_error = max_error;
        return measure_filter(scene, volume).trials.hardware.at(0);
    };
    const double just_kept = trial(1).error / trial(1).goal;
    EXPECT_TRUE(trial(1.01 * just_kept).keeps_goal());
    EXPECT_FALSE(trial(.99 * just_kept).keeps_goal());
}

TEST(SlabTrials, NoFilterIsTriedUnlessItIsAutomaticAndPossible) {
    Volume volume = gaussians(8);
    Scene scene = unit_box_scene(smooth_transfer_function(), Projection::perspective);
    scene.slice.samples = 9;
    const auto trials = [&] { return measure_filter(scene, volume).trials.hardware.size(); };
    EXPECT_EQ(trials(), 0u);
    scene.slice.filter = automatic;
    EXPECT_EQ(trials(), 1u);
    EXPECT_TRUE(try_slabs(scene, volume).trials.hardware.empty());
    scene.transfer_function = TransferFunction::linear({knot(0, {.2, .4, .8}, 2)});
    EXPECT_EQ(trials(), 0u);
    scene.transfer_function = smooth_transfer_function();
    scene.nan = NanPolicy::transparent;
    std::vector<float> samples(8 * 8 * 8, .5f);
    samples[9] = .75f;
    samples[100] = NAN;
    volume = reference_test::make_volume(volume.grid(), samples);
    EXPECT_EQ(trials(), 0u);
}

}  // namespace
}  // namespace lamina
