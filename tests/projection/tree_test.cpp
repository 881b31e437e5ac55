// SPDX-License-Identifier: Apache-2.0
// Exponent-factoring of tets (LaMar 2004, section 6): leaves are sets of tets, nodes fixed-point
// buffers.
#include "projection_fixture.h"
#include "support/split_box.h"

namespace lamina {
namespace {

class TetTree : public ProjectionTest {
  protected:
    // A box of constant scalar with 8 cells along an edge; a ray's opacity is 1 - exp(-extinction *
    // chord).
    TetTree() : mesh_(scene_mesh(test::kuhn_box({8, 8, 8}, [](const auto&) { return 0.0; }))) {}

    // Returns a white scene; the box's diagonal, no shorter than any chord, has optical depth
    // `depth`.
    Scene scene(Target target, double depth) const {
        Scene scene = projection_scene(
            TransferFunction::linear({knot(0, {1, 1, 1}, depth / (8 * std::sqrt(3.0)))}), 64, 48);
        scene.camera->eye = {15, -9, 13};
        scene.camera->center = {4, 4, 4};
        scene.camera->fov_y = 45;
        scene.target = target;
        return scene;
    }
    static Scene with_tree(Scene scene, const std::vector<int>& factors) {
        scene.project.tree = TreeSettings{.factors = factors, .nodes = NodeArithmetic::fixed};
        return scene;
    }
    ErrorNorms error(const Scene& scene, const Scene& reference) const {
        return image_error(project(mesh_, scene, capabilities()),
                           project(mesh_, reference, capabilities()))
            .all;
    }

    SceneMesh mesh_;
};

// The bound is in codes of 16 bits. A ray meets at most F = 72 tets: 27 planes x, y, z = const and
// 45 x - y, y - z, x - z = const cut the box. Each OVER in a leaf is off by e: .5 for opacity and
// .5 for the result, 1 for a result rounded by chance, 1.5 for opacity rounded by chance and then
// the result. The swizzle of a child into its parent has the slope s e^(x (1 - s)), with the share
// s = 1/8 and the child's multiplied depth x, at most 64 D in leaves and 8 D in nodes, D being the
// box's depth; it and OVER round by .5 each. The root is off by at most
//     F e / 64 e^((56 + 7) D) + 8 e^(7 D) + 8.
// A leaf's error of F moves x by .004 (D = .02): another half percent of the first term.
TEST_P(TetTree, IsAsPreciseAsItsNodes) {
    const double depth = .02;
    const Scene exact = scene(Target::float32, depth);
    for (const auto& [dither, rounding] :
         {std::pair{ProjectDither::none, 1.0}, std::pair{ProjectDither::after_blend, 1.0},
          std::pair{ProjectDither::alpha, 1.5}}) {
        const double codes =
            1.005 * 72 * rounding / 64 * std::exp(63 * depth) + 8 * std::exp(7 * depth) + 8;
        for (const auto& order :
             {Auto<ProjectOrder>(automatic), Auto<ProjectOrder>(ProjectOrder::exact)}) {
            Scene tree = with_tree(scene(Target::fixed16, depth), {8, 8});
            tree.project.dither = dither;
            tree.project.order = order;
            EXPECT_LE(error(tree, exact).linf, codes / 257)
                << name_of(dither) << ", order " << name_of(order);
        }
    }
}

// Native blending rounds opacity to nearest and fuses (docs/numerics.md, section 2), as this
// emulation does, except for sums half-way between codes. Both stay within the bound of
// IsAsPreciseAsItsNodes, for e = 1.
TEST_P(TetTree, EmulatedNodesMatchNativeOnes) {
    const double depth = .02;
    Scene emulated = with_tree(scene(Target::emulated, depth), {8, 8});
    emulated.emulate = {16, AlphaRounding::nearest, OverRounding::fused, 1};
    const double codes = 1.005 * 72.0 / 64 * std::exp(63 * depth) + 8 * std::exp(7 * depth) + 8;
    EXPECT_LE(error(emulated, with_tree(scene(Target::fixed16, depth), {8, 8})).linf,
              2 * codes / 257);
}

// One leaf holds all tets, and its depths are multiplied by 1. The opacity of a node times white is
// the picture itself.
TEST_P(TetTree, IsThePlainPictureWithOneLeaf) {
    Scene plain = scene(Target::fixed8, 2);
    plain.project.order = ProjectOrder::exact;
    EXPECT_EQ(error(with_tree(plain, {1}), plain).linf, 0);
}

// In a buffer of 8 bits, tets of less than half a code vanish and others become a whole code; in
// leaves they are four times as dense. The bound of IsAsPreciseAsItsNodes for one level, 72 / 4
// e^(3 D) + 4, is weaker than this test's, because roundings of tets that differ average out.
TEST_P(TetTree, HalvesTheErrorWhereTetsAreThin) {
    const Scene exact = scene(Target::float32, .1);
    const Scene plain = scene(Target::fixed8, .1);
    EXPECT_LE(error(with_tree(plain, {4}), exact).l2, .5 * error(plain, exact).l2);
}

// Nothing of one frame's buffers shows in the next frame.
TEST_P(TetTree, DrawsEveryFrameAlike) {
    const Scene wanted = with_tree(scene(Target::fixed8, 1), {5, 3});
    const Plan plan = plan_of(mesh_, wanted, capabilities());
    EXPECT_TRUE(plan.project.scattered);
    const auto renderer = make_renderer(mesh_, wanted, capabilities());
    const View view(*wanted.camera, wanted.width, wanted.height);
    renderer->draw(view);
    const Image first = renderer->read();
    renderer->draw(view);
    EXPECT_EQ(renderer->read().rgba, first.rgba);
    EXPECT_EQ(renderer->step_count(), 15);
}

INSTANTIATE_TEST_SUITE_P(Engines, TetTree, every_engine, engine_name);

}  // namespace
}  // namespace lamina
