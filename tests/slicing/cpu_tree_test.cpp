// SPDX-License-Identifier: Apache-2.0
// Compositing trees in the cpu engine, against OpenGL's and against straight compositing.

#include "cpu_fixture.h"

namespace lamina {
namespace {

class CpuTreeTest : public SlicingTest {
  protected:
    Volume volume_ =
        generate({"mixing", std::array<std::int64_t, 3>{40, 40, 40}, SampleType::uint8});
    TransferFunction hues_ =
        TransferFunction::linear({knot(0, {.1, 1, .2}, .1), knot(120, {.2, .1, 1}, 2),
                                  knot(140, {1, 1, .1}, 9), knot(255, {1, .6, .1}, 4)});

    Scene scene_of(int samples, Target target, const std::vector<int>& factors) const {
        Scene scene = unit_box_scene(hues_, Projection::perspective, 37, 29);
        scene.slice.samples = samples;
        scene.target = target;
        if (!factors.empty()) scene.slice.tree = TreeSettings{.factors = factors};
        return scene;
    }
};

// tree_test.cpp
TEST_F(CpuTreeTest, FloatNodesMatchStraightCompositing) {
    for (const int samples : {1000, 1021, 1024}) {
        const Image straight = render_tiles(volume_, scene_of(samples, Target::float32, {}),
                                            keep("early_termination"));
        for (const std::vector<int>& factors :
             {std::vector<int>{32, 32}, {7, 3, 5}, {1}, {2, 2, 2, 2, 2, 2, 2, 2, 2, 2}}) {
            EXPECT_LE(
                linf(render_tiles(volume_, scene_of(samples, Target::float32, factors)), straight),
                255 * 1e-5)
                << samples << " " << factors.size() << " levels";
        }
    }
}

// A node's code or colour on the border between two may round to either side; that is one rounding,
// and the bounds of tree_test.cpp allow one for each level.
TEST_F(CpuTreeTest, NodesMatchOpenGl) {
    for (const NodeCode code : {NodeCode::minimax, NodeCode::phi, NodeCode::alpha}) {
        for (const auto& [target, alpha_bits] :
             {std::pair{Target::fixed8, 8}, std::pair{Target::fixed8, 16},
              std::pair{Target::fixed16, 8}, std::pair{Target::float16, 8},
              std::pair{Target::float32, 8}}) {
            Scene scene = scene_of(300, target, {10, 6, 5});
            (*scene.slice.tree)->code = code;
            (*scene.slice.tree)->alpha_bits = alpha_bits;
            const Image tiles = render_tiles(volume_, scene);
            const Image shaders = render(volume_, scene, capabilities());
            const double one = target == Target::fixed8    ? 255. / 255
                               : target == Target::fixed16 ? 255. / 65535
                               : target == Target::float16 ? 255. / 2048
                                                           : 255. * 1e-5;
            EXPECT_LE(linf(tiles, shaders), 3 * one)
                << name_of(code) << " " << name_of(target) << " " << alpha_bits;
            // Nearly everywhere they are the same.
            EXPECT_LE(image_error(tiles, shaders).all.l2, .3 * one);
        }
    }
}

// Bounds and reasons: tree_test.cpp.
TEST_F(CpuTreeTest, ColorsKeepTheirErrorBound) {
    const Image expected = render_tiles(volume_, scene_of(1024, Target::float32, {}));
    const Image image = render_tiles(volume_, scene_of(1024, Target::fixed8, {32, 32}));
    EXPECT_LE(linf(image, expected), 2.2);
    EXPECT_GT(linf(image, expected), 0);
}

// Both have the same bricks, because OpenGL, too, keeps the volume's own type if it has no exact
// filter.
TEST_F(CpuTreeTest, BricksAreMarchedInOrder) {
    Capabilities small = cpu_capabilities(), small_textures = capabilities();
    small_textures.exact_float_filter = false;
    small.max_texture_bytes = small_textures.max_texture_bytes = 16 * 37 * 29 + 100;
    for (const std::vector<int>& factors : {std::vector<int>{}, {10, 6}}) {
        const Scene scene = scene_of(300, Target::float32, factors);
        EXPECT_LE(
            linf(render_tiles(volume_, scene, {}, small), render(volume_, scene, small_textures)),
            255 * 2e-5);
    }
}

TEST_F(CpuTreeTest, NativeFixedNodesMatchOpenGl) {
    hues_ = TransferFunction::linear({knot(0, {.4, .7, 1}, .9), knot(255, {.4, .7, 1}, 1)});
    for (const Target target : {Target::fixed8, Target::fixed16}) {
        for (const Order order : {Order::back_to_front, Order::front_to_back}) {
            for (const std::vector<int>& factors :
                 {std::vector<int>{32, 32}, std::vector<int>(10, 2)}) {
                Scene scene = scene_of(1024, target, factors);
                scene.slice.order = order;
                (*scene.slice.tree)->nodes = NodeArithmetic::fixed;
                const double scale = target == Target::fixed8 ? 1 : 1. / 257;
                const auto levels = static_cast<double>(factors.size());
                EXPECT_LE(
                    linf(render_tiles(volume_, scene), render(volume_, scene, capabilities())),
                    scale * (levels + .01));
            }
        }
    }
}

}  // namespace
}  // namespace lamina
