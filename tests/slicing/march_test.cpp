// SPDX-License-Identifier: Apache-2.0
// Rays that compute shaders march in several dispatches, against the cpu engine and against one
// dispatch.
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <set>
#include <vector>

#include "cpu_fixture.h"
#include "slicing/gl_march.h"

namespace lamina {
namespace {

class MarchTest : public gl::EveryContextTest {
  protected:
    Volume volume_ =
        generate({"mixing", std::array<std::int64_t, 3>{20, 20, 20}, SampleType::uint8});

    // Returns a transfer function of 256 points, which llvmpipe's loops count for every slab.
    static TransferFunction many_points() {
        std::vector<TransferKnot> knots;
        for (int i = 0; i < 256; ++i)
            knots.push_back(knot(i, {.5 + .5 * std::sin(i), .5, .1 * (i % 9)}, .5 + .25 * (i % 7)));
        return TransferFunction::linear(knots);
    }

    static Scene scene_of(int samples, const TransferFunction& transfer_function) {
        Scene scene = unit_box_scene(transfer_function, Projection::perspective, 21, 17);
        scene.slice.samples = samples;
        return scene;
    }

    SlicePlan plan_of(const Scene& scene, const Capabilities& capabilities) const {
        const Facts facts = measure(scene, volume_, measure_bricks(volume_));
        return make_plan(scene, facts, capabilities, {}).slice;
    }
};

INSTANTIATE_TEST_SUITE_P(, MarchTest, gl::both_contexts, gl::context_name);

// A dispatch rounds a ray's sums to float once, by at most 2^-24 of 1. There are at most 65536 / 20
// dispatches, but few of them see enough of a ray to matter: the bound is that of the cpu engine
// against OpenGL (cpu_tree_test.cpp).
TEST_P(MarchTest, MoreSlabsThanLoopsAllowAreDrawnInSeveralDispatches) {
    for (const Classification each : {Classification::post, Classification::preintegrated}) {
        Scene scene = scene_of(65536, many_points());
        scene.slice.classification = each;
        EXPECT_EQ(plan_of(scene, capabilities()).marched_slabs < 65536, capabilities().software);
        EXPECT_LE(linf(render(volume_, scene, capabilities()), render_tiles(volume_, scene)),
                  255 * 1e-5)
            << name_of(each);
    }
}

// Codes are whole numbers, so that dispatches cannot change them.
TEST_P(MarchTest, DispatchesKeepCodes) {
    Scene scene = scene_of(3000, many_points());
    scene.target = Target::emulated;
    for (const Order order : {Order::back_to_front, Order::front_to_back}) {
        scene.slice.order = order;
        const Image expected = render(volume_, scene, capabilities());
        const Facts facts = measure(scene, volume_, measure_bricks(volume_));
        Plan plan = make_plan(scene, facts, capabilities(), {});
        for (const int slabs : {1000, 7}) {
            plan.slice.marched_slabs = slabs;
            GlSliceRenderer renderer(volume_, *scene.transfer_function, facts, plan.slice,
                                     capabilities(), scene.width, scene.height);
            renderer.draw(View(*scene.camera, scene.width, scene.height));
            EXPECT_EQ(linf(renderer.read(), expected), 0) << slabs;
        }
    }
}

// Exact segments do not depend on where a ray is cut. Rays end early in any dispatch and brick.
TEST_P(MarchTest, DispatchesAndBricksKeepExactPictures) {
    const TransferFunction dense = TransferFunction::linear(
        {knot(0, {.1, .2, .6}, 0), knot(90, {.2, .7, .5}, 9), knot(255, {1, .2, .1}, 90)});
    Scene scene = scene_of(64, dense);
    scene.slice.classification = Classification::exact;
    const Image expected = trace(volume_, scene, 1e-8);
    const Facts facts = measure(scene, volume_, measure_bricks(volume_));
    Capabilities small = capabilities();
    small.max_3d_texture_size = 12;
    for (const Capabilities& each : {capabilities(), small}) {
        Plan plan = make_plan(scene, facts, each, {});
        EXPECT_TRUE(plan.slice.ends_early());
        EXPECT_EQ(plan.slice.bricks.size(), each.max_3d_texture_size == 12 ? 8u : 1u);
        for (const int slabs : {64, 5}) {
            plan.slice.marched_slabs = slabs;
            GlSliceRenderer renderer(volume_, *scene.transfer_function, facts, plan.slice, each,
                                     scene.width, scene.height);
            renderer.draw(View(*scene.camera, scene.width, scene.height));
            // Rays that end early miss at most .002; the rest is the segments' own error.
            EXPECT_LE(linf(renderer.read(), expected), .002 + exact_segment_error) << slabs;
        }
    }
}

// Each ray is marched alone, whatever tile and workgroup draw it and wherever its samples lie.
TEST_P(MarchTest, EveryDispatchOfRaysDrawsTheSame) {
    Scene scene = scene_of(64, many_points());
    for (const Target target : {Target::float32, Target::emulated}) {
        for (const Classification each : {Classification::exact, Classification::preintegrated}) {
            scene.target = target;
            scene.slice.classification = each;
            const Image expected = render(volume_, scene, capabilities());
            for (const RayDispatch& rays :
                 {RayDispatch{32, false, true}, RayDispatch{64, true}, RayDispatch{128, true, true},
                  RayDispatch{32, true, false, true}}) {
                Capabilities other = capabilities();
                other.rays = rays;
                other.sample_words = !plan_of(scene, capabilities()).words;
                EXPECT_EQ(render(volume_, scene, other).rgba, expected.rgba)
                    << name_of(each) << ", workgroups of " << rays.group;
            }
        }
    }
}

// A GPU's dispatches are chosen by their times, and leaves of trees are not waited for one by one.
TEST_P(MarchTest, DispatchesThatAreTimedDrawTheSame) {
    Capabilities timed = capabilities();
    timed.software = false;
    const TransferFunction white =
        TransferFunction::linear({knot(0, {1, 1, 1}, .9), knot(255, {1, 1, 1}, 1)});
    for (const Target target : {Target::float32, Target::emulated}) {
        for (const bool tree : {false, true}) {
            Scene scene = scene_of(64, tree ? white : many_points());
            scene.height = 170;
            scene.target = target;
            if (tree) {
                scene.slice.tree = TreeSettings{.factors = {8, 8}};
                if (target == Target::emulated) (*scene.slice.tree)->nodes = NodeArithmetic::fixed;
            }
            const Facts facts = measure(scene, volume_, measure_bricks(volume_));
            const SlicePlan plan = plan_of(scene, capabilities());
            const Image expected = render(volume_, scene, capabilities());
            GlSliceRenderer renderer(volume_, *scene.transfer_function, facts, plan, timed,
                                     scene.width, scene.height);
            for (int frame = 0; frame < 3; ++frame) {
                renderer.draw(View(*scene.camera, scene.width, scene.height));
                EXPECT_EQ(renderer.read().rgba, expected.rgba) << name_of(target) << " " << tree;
            }
        }
    }
}

// Costs of tiles are known from the second frame on.
TEST_P(MarchTest, TilesSortedByCostDrawTheSame) {
    if (!gl::has_extension("GL_ARB_shader_clock")) GTEST_SKIP() << "no clock in shaders";
    Capabilities sorted = capabilities();
    sorted.rays.sorted = true;
    Scene scene = scene_of(64, many_points());
    for (const Target target : {Target::float32, Target::emulated}) {
        scene.target = target;
        const Facts facts = measure(scene, volume_, measure_bricks(volume_));
        const auto renderer_of = [&](const Capabilities& each) {
            return std::make_unique<GlSliceRenderer>(volume_, *scene.transfer_function, facts,
                                                     make_plan(scene, facts, each, {}).slice, each,
                                                     scene.width, scene.height);
        };
        const auto expected = renderer_of(capabilities()), found = renderer_of(sorted);
        Camera camera = *scene.camera;
        for (int frame = 0; frame < 3; ++frame) {
            const View view(camera, scene.width, scene.height);
            expected->draw(view);
            found->draw(view);
            EXPECT_EQ(found->read().rgba, expected->read().rgba) << frame;
            camera.eye.x += .1;
        }
    }
}

// Cells to cut lie in many places of a wave, so that rays of a group meet their first, second, ...
// one in different steps. Who cuts with whom must not change a bit: unlit and lit, in one dispatch
// and in several, in fragment shaders, and if a cell that waits hides all behind it.
TEST_P(MarchTest, RaysThatCutAloneDrawTheSame) {
    if (!gl::has_extension("GL_ARB_shader_group_vote")) GTEST_SKIP() << "no votes in shaders";
    Capabilities alone = capabilities();
    alone.rays.alone = true;
    const TransferFunction shells = TransferFunction::linear(
        {knot(0, {.1, .2, .6}, 0), knot(90, {.2, .7, .5}, 0), knot(92, {.2, .7, .5}, 3000),
         knot(94, {.2, .7, .5}, 0), knot(180, {.9, .7, .5}, 9), knot(255, {1, .2, .1}, 40)});
    Lighting lighting;
    lighting.smallest_gradient = .01;
    for (const TransferFunction& transfer_function : {many_points(), shells}) {
        Scene scene = scene_of(64, transfer_function);
        scene.slice.classification = Classification::exact;
        for (const bool lit : {false, true}) {
            if (lit) scene.lighting = lighting;
            const Facts facts = measure(scene, volume_, measure_bricks(volume_));
            for (const Target target : {Target::float32, Target::emulated, Target::fixed8}) {
                scene.target = target;
                for (const int slabs : {64, 5}) {
                    const auto drawn = [&](const Capabilities& each) {
                        Plan plan = make_plan(scene, facts, each, {});
                        plan.slice.marched_slabs = slabs;
                        GlSliceRenderer renderer(volume_, *scene.transfer_function, facts,
                                                 plan.slice, each, scene.width, scene.height);
                        renderer.draw(View(*scene.camera, scene.width, scene.height));
                        return renderer.read().rgba;
                    };
                    EXPECT_EQ(drawn(alone), drawn(capabilities()))
                        << lit << " " << name_of(target) << " " << slabs;
                }
            }
        }
    }
}

// A shader copies the list, and says that the tile of a column and row of the picture takes
// (3 column + 5 row) % 11; one was interrupted, which took almost 2^32. The drawn pixels begin
// within a tile.
TEST_P(MarchTest, TilesThatTookLongestComeFirst) {
    constexpr int columns = 8, rows = 6;  // of 61 x 45 pixels
    const DrawnPixels pixels{3, 5, 50, 44};
    const int across = 6, down = 5;  // tiles of these
    const auto cost = [](int column, int row) {
        return column == 4 && row == 3 ? 0xfffffff0u
                                       : static_cast<unsigned>(3 * column + 5 * row) % 11;
    };
    gl::Program program = gl::compute_program(R"(#version 450 core
        layout(local_size_x = 1) in;
        layout(std430, binding = 0) writeonly buffer Copy { uint copied[]; };
        layout(std430, binding = 5) readonly buffer Order { uint tile_order[]; };
        layout(std430, binding = 6) writeonly buffer Costs { uint tile_costs[]; };
        uniform int cost_columns;
        void main() {
            uvec2 tile = gl_WorkGroupID.xy;
            uint place = tile.y * gl_NumWorkGroups.x + tile.x;
            copied[place] = tile_order[place];
            uint cost = tile == uvec2(4, 3) ? 0xfffffff0u : (3u * tile.x + 5u * tile.y) % 11u;
            tile_costs[tile.y * uint(cost_columns) + tile.x] = cost;
        }
    )");
    TilesByCost tiles(61, 45, 64);
    const gl::Buffer copy(columns * rows * sizeof(std::uint32_t));
    std::vector<unsigned> costs;  // in the order of the list
    for (int frame = 0; frame < 2; ++frame) {
        tiles.begin_frame();
        tiles.bind(pixels, program);
        copy.bind_storage(0);
        program.dispatch(columns, rows);
        tiles.end_frame();
        std::vector<std::uint32_t> listed(across * down);
        copy.read(std::span(listed));
        std::set<std::uint32_t> all;
        costs.clear();
        for (std::size_t i = 0; i < listed.size(); ++i) {
            const auto column = static_cast<int>(listed[i] & 0xffff);
            const auto row = static_cast<int>(listed[i] >> 16);
            if (frame == 0) {
                EXPECT_EQ(row * across + column, static_cast<int>(i));
            }
            EXPECT_TRUE(column < across && row < down);
            all.insert(listed[i]);
            costs.push_back(cost((3 + 8 * column) / 8, (5 + 8 * row) / 8));
        }
        EXPECT_EQ(all.size(), listed.size());
    }
    EXPECT_TRUE(std::ranges::is_sorted(costs, std::greater()));
    EXPECT_GT(costs.front(), costs.back());
}

}  // namespace
}  // namespace lamina
