// SPDX-License-Identifier: Apache-2.0
// Compositing trees whose nodes are computed by shaders, against the same slabs blended in float32.
#include <algorithm>
#include <random>

#include "slicing_fixture.h"

namespace lamina {
namespace {

constexpr std::int64_t volume_edge = 40;

Volume generated(const std::string& name) {
    return generate({name, std::array{volume_edge, volume_edge, volume_edge}, SampleType::uint8});
}

Volume white_noise() {
    std::mt19937 random(3);
    std::vector<float> samples(volume_edge * volume_edge * volume_edge);
    for (float& sample : samples) sample = static_cast<float>(random() % 256);
    return reference_test::make_volume(
        reference_test::make_grid({volume_edge, volume_edge, volume_edge}, Centering::node,
                                  glm::dvec3(1.0 / (volume_edge - 1))),
        std::move(samples));
}

TransferFunction random_hues(double most_extinction) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(0, 1);
    std::vector<TransferKnot> knots;
    for (int value = 0; value < 256; value += 4) {
        knots.push_back(knot(value, {unit(random), unit(random), unit(random)},
                             most_extinction * unit(random)));
    }
    return TransferFunction::linear(knots);
}

struct Example {
    const char* name;
    Volume volume;
    TransferFunction transfer_function;
};

std::vector<Example> examples() {
    const auto two = [](double lo, double hi) {
        return TransferFunction::linear({knot(0, {.1, 1, .2}, lo), knot(255, {1, .6, .1}, hi)});
    };
    std::vector<Example> all;
    all.push_back({"mixing", generated("mixing"), two(.1, 4)});
    all.push_back({"random hues", generated("mixing"), random_hues(6)});
    all.push_back({"sheets", generated("sheets"), two(0, 60)});
    all.push_back({"white noise", white_noise(), random_hues(5)});
    all.push_back({"faint", generated("mixing"), random_hues(.05)});
    all.push_back({"dense", generated("mixing"), random_hues(400)});
    return all;
}

Scene scene_of(const Example& example, int samples, Target target,
               const std::vector<int>& factors) {
    Scene scene = unit_box_scene(example.transfer_function, Projection::perspective, 32, 24);
    scene.slice.samples = samples;
    scene.target = target;
    if (!factors.empty()) scene.slice.tree = TreeSettings{.factors = factors};
    return scene;
}

using TreeTest = SlicingTest;

TEST_F(TreeTest, FloatNodesMatchStraightCompositing) {
    for (const Example& example : examples()) {
        for (const int samples : {1000, 1021, 1024, 4096}) {
            Scene straight = scene_of(example, samples, Target::float32, {});
            straight.slice.order = Order::front_to_back;
            const Image expected =
                render(example.volume, straight, capabilities(), keep("early_termination"));
            const Image blended =
                render(example.volume, straight, capabilities(), leave_nothing_out());
            // Blending rounds sums below 1 once for each slab, by up to 2^-25 each for colour and
            // opacity, and always in the same direction if the volume is smooth. As much shows
            // through behind full opacity (LaMar's pigeon-hole error, in float32;
            // docs/precision.md).
            EXPECT_LE(linf(blended, expected), 255 * samples * 0x1p-24) << example.name;
            for (const std::vector<int>& factors :
                 {std::vector<int>{32, 32}, {7, 3, 5}, {1}, {2, 2, 2, 2, 2, 2, 2, 2, 2, 2}}) {
                const Image image =
                    render(example.volume, scene_of(example, samples, Target::float32, factors),
                           capabilities());
                EXPECT_LE(linf(image, expected), 255 * 1e-5)
                    << example.name << " " << samples << " " << factors.size() << " levels";
            }
        }
    }
}

// Writing a minimax code costs the opacity at most 1.445 Y / 2 (docs/numerics.md, section 4), which
// is 1.64 with 32 children and 1.83 with 64, and the root costs .5: together less than these
// bounds. Colours may be off by another .5, with convex weights; in these scenes, which are not the
// worst, the bounds hold nevertheless. With an alpha of 16 bits only both roundings of .5 remain,
// and 1.83 / 257.
TEST_F(TreeTest, ColorsKeepTheirErrorBound) {
    for (const Example& example : examples()) {
        for (const auto& [samples, factor, most] :
             {std::tuple{1024, 32, 2.2}, std::tuple{4096, 64, 2.4}}) {
            const Image expected = render(
                example.volume, scene_of(example, samples, Target::float32, {}), capabilities());
            Scene scene = scene_of(example, samples, Target::fixed8, {factor, factor});
            EXPECT_LE(linf(render(example.volume, scene, capabilities()), expected), most)
                << example.name;
            (*scene.slice.tree)->alpha_bits = 16;
            EXPECT_LE(linf(render(example.volume, scene, capabilities()), expected), 1.02)
                << example.name;
        }
    }
}

// Fixed-point images of nodes hold colours above 1 divided by the largest colour; only the picture
// is clamped. So colours are coarser by that factor: half a code times it for each of two levels,
// in addition to the errors of alpha codes.
TEST_F(TreeTest, ColorsAboveOneKeepTheirErrorBound) {
    const Example faint{
        "faint, bright", generated("mixing"),
        TransferFunction::linear({knot(0, {3, 0, .5}, 0), knot(255, {.5, 3, 1}, .2)})};
    const Image expected =
        render(faint.volume, scene_of(faint, 1024, Target::float32, {}), capabilities());
    ASSERT_LE(*std::max_element(expected.rgba.begin(), expected.rgba.end()), 1);
    const Scene scene = scene_of(faint, 1024, Target::fixed8, {32, 32});
    EXPECT_LE(linf(render(faint.volume, scene, capabilities()), expected), 3 * 1.64 + 3 * .5 + .5);
}

// Phi of a thin dense sheet rounds to 1 (docs/numerics.md, section 3).
TEST_F(TreeTest, PhiFailsOnSheetsAndAutoDoesNotChooseIt) {
    const Example sheets = examples()[2];
    const Image expected =
        render(sheets.volume, scene_of(sheets, 1024, Target::float32, {}), capabilities());
    Scene scene = scene_of(sheets, 1024, Target::fixed8, {32, 32});
    (*scene.slice.tree)->code = NodeCode::phi;
    EXPECT_GT(linf(render(sheets.volume, scene, capabilities()), expected), 50);
    scene.slice.tree = automatic;
    EXPECT_LE(linf(render(sheets.volume, scene, capabilities()), expected), 1);
}

TEST_F(TreeTest, AutomaticTreesStayUnderTheirBound) {
    for (const Example& example : examples()) {
        const Image expected = render(example.volume, scene_of(example, 1024, Target::float32, {}),
                                      capabilities(), keep("early_termination"));
        for (const Target target : {Target::fixed8, Target::fixed16, Target::float16}) {
            for (const double max_error : {1.0, 2.0, 4.0, 8.0}) {
                Scene scene = scene_of(example, 1024, target, {});
                scene.slice.tree = automatic;
                scene.max_error = max_error;
                const Facts facts = measure(scene, example.volume, measure_bricks(example.volume));
                const Plan plan = make_plan(scene, facts, capabilities(), {});
                ASSERT_TRUE(plan.slice.error_bound);
                EXPECT_LE(*plan.slice.error_bound, max_error);
                EXPECT_LE(linf(render(example.volume, scene, capabilities()), expected),
                          *plan.slice.error_bound)
                    << example.name << " " << name_of(target);
            }
        }
    }
}

// With one colour, images of nodes have one channel.
TEST_F(TreeTest, MonochromeTreesNeedOneChannel) {
    const TransferFunction grey =
        TransferFunction::linear({knot(0, {.5, .5, .5}, .1), knot(255, {.5, .5, .5}, 6)});
    const Example example{"grey", generated("mixing"), grey};
    const Image expected =
        render(example.volume, scene_of(example, 1024, Target::float32, {}), capabilities());
    const Scene scene = scene_of(example, 1024, Target::fixed8, {32, 32});
    const Image image = render(example.volume, scene, capabilities());
    EXPECT_LE(linf(image, expected), 2.2);
    const Image with_color = render(example.volume, scene, capabilities(), leave_nothing_out());
    EXPECT_LE(linf(with_color, expected), 2.2);
}

// Bricks of the volume and bands of rows change nothing but the rounding of a leaf's sum.
TEST_F(TreeTest, BricksAndBandsKeepThePicture) {
    const Example example = examples()[1];
    const Scene scene = scene_of(example, 500, Target::float32, {20, 25});
    const Image expected = render(example.volume, scene, capabilities());
    Capabilities small = capabilities();
    small.max_3d_texture_size = 24;
    // Segments are cut where bricks meet, and post-classified segments sample their middles, so the
    // straight picture must have the same bricks.
    Scene straight = scene_of(example, 500, Target::float32, {});
    const Image straight_bricks = render(example.volume, straight, small);
    EXPECT_LE(linf(render(example.volume, scene, small), straight_bricks), 255 * 1e-5);
    Capabilities hardware = capabilities();
    hardware.software = false;  // one band
    OmissionSwitch double_rays;
    double_rays.kept = {"double_precision"};
    EXPECT_EQ(linf(render(example.volume, scene, hardware, double_rays), expected), 0);
}

// Extinction hardly varies, so an error in a node's Phi reaches the root multiplied by the node's
// share. A level adds at most .5 for rounding each swizzled child and .5 for each OVER.
TEST_F(TreeTest, NativeFixedNodesAddErrorsByLevels) {
    const TransferFunction white =
        TransferFunction::linear({knot(0, {1, 1, 1}, .9), knot(255, {1, 1, 1}, 1)});
    const Example example{"white", generated("mixing"), white};
    const Image expected =
        render(example.volume, scene_of(example, 1024, Target::float32, {}), capabilities());
    for (const auto& [target, scale] :
         {std::pair{Target::fixed8, 1.0}, std::pair{Target::fixed16, 1.0 / 257}}) {
        for (const Order order : {Order::back_to_front, Order::front_to_back}) {
            Scene scene = scene_of(example, 1024, target, {});
            scene.slice.order = order;
            EXPECT_GT(linf(render(example.volume, scene, capabilities()), expected), 20 * scale);
            for (const int height : {2, 10}) {
                scene.slice.tree =
                    TreeSettings{.factors = std::vector<int>(height, height == 2 ? 32 : 2),
                                 .nodes = NodeArithmetic::fixed};
                const double children = height == 2 ? 32 : 2;
                EXPECT_LE(linf(render(example.volume, scene, capabilities()), expected),
                          scale * height * .5 * (children + 1))
                    << name_of(target) << " " << name_of(order) << " " << height;
            }
        }
    }
}

}  // namespace
}  // namespace lamina
