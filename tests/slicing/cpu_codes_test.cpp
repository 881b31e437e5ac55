// SPDX-License-Identifier: Apache-2.0
// The cpu engine's codes equal those of OpenGL's shaders and blending, pixel by pixel, and those of
// the core (src/compositing).

#include "compositing/codes.h"
#include "compositing/fixed_ray.h"
#include "cpu_fixture.h"
#include "ramp_scene.h"

namespace lamina {
namespace {

// Returns how many components of two pictures are not the same code. OpenGL multiplies codes by a
// rounded 1 / M when it reads them back, which is off by 1.2e-7 of the value; codes, and numbers of
// half precision that matter here, lie at least 1.5e-5 apart.
int differing(const Image& a, const Image& b) {
    int count = 0;
    for (std::size_t i = 0; i < a.rgba.size(); ++i)
        count += std::abs(a.rgba[i] - b.rgba[i]) > 1e-6f ? 1 : 0;
    return count;
}

const std::vector<std::vector<int>> trees{{}, {64}, {4, 16}, {5, 3}, {1, 4, 4}, {2, 2, 2, 2, 2, 2}};

class CpuCodesTest : public SlicingTest {
  protected:
    Volume ramp_ = generate({"ramp", {}, SampleType::uint8});

    void expect_same_ramp(const Scene& scene) {
        EXPECT_EQ(differing(render_tiles(ramp_, scene), render(ramp_, scene, capabilities())), 0)
            << name_of(scene.target) << ", " << scene.emulate.bits << " bits, alpha "
            << name_of(scene.emulate.alpha) << ", over " << name_of(scene.emulate.over) << ", "
            << name_of(scene.slice.order) << ", tree "
            << (scene.slice.tree ? to_text((*scene.slice.tree)->factors) : "") << ", dither "
            << (scene.slice.dither ? scene.slice.dither->increment : 0);
    }
};

// ramp_test.cpp and emulated_test.cpp compare OpenGL's ramp with simulations in integers.
TEST_F(CpuCodesTest, RampsMatchTheShadersInEveryPixel) {
    for (const int bits : {1, 4, 8, 13, 16}) {
        for (const AlphaRounding alpha :
             {AlphaRounding::truncate, AlphaRounding::nearest, AlphaRounding::stochastic}) {
            for (const OverRounding over : {OverRounding::separate, OverRounding::fused}) {
                for (const Order order : {Order::back_to_front, Order::front_to_back}) {
                    const std::size_t which =
                        static_cast<std::size_t>(bits + (order == Order::front_to_back ? 1 : 0));
                    Scene scene = ramp_scene(glm::dvec3(.2, .5, 1));
                    scene.slice.samples = 64;
                    scene.slice.order = order;
                    scene.emulate = {bits, alpha, over, 99};
                    expect_same_ramp(scene);
                    if (alpha == AlphaRounding::truncate) continue;
                    scene.transfer_function = ramp_scene(glm::dvec3(.5)).transfer_function;
                    scene.slice.tree = TreeSettings{.factors = trees[1 + which % 5],
                                                    .nodes = NodeArithmetic::fixed};
                    expect_same_ramp(scene);
                }
            }
        }
    }
}

TEST_F(CpuCodesTest, DitheredRampsMatchTheShadersInEveryPixel) {
    for (const Target target : {Target::emulated, Target::fixed8, Target::fixed16}) {
        for (const int increment : {1, 4}) {
            for (const bool color : {false, true}) {
                for (const Order order : {Order::back_to_front, Order::front_to_back}) {
                    Scene scene = ramp_scene(glm::dvec3(.3));
                    scene.target = target;
                    scene.slice.samples = 64;
                    scene.slice.order = order;
                    scene.slice.dither = DitherSettings{11, 5, color, increment};
                    expect_same_ramp(scene);
                    scene.slice.tree =
                        TreeSettings{.factors = {4, 16}, .nodes = NodeArithmetic::fixed};
                    expect_same_ramp(scene);
                }
            }
        }
    }
}

// Compares with the core (compositing/fixed_ray.h), which shares no code with the cpu engine's
// vectors.
TEST_F(CpuCodesTest, StraightRampsMatchTheFixedPointSimulation) {
    for (const std::optional<Dither>& dither :
         {std::optional<Dither>(), {Dither{11, 5, true, 4}}}) {
        Scene scene = ramp_scene(glm::dvec3(.3));
        scene.slice.samples = 64;
        scene.emulate = {8, AlphaRounding::nearest, OverRounding::separate, 1};
        if (dither) scene.slice.dither = DitherSettings{11, 5, true, 4};
        const Image image = render_tiles(ramp_, scene);
        for (int x = 0; x < ramp_width; ++x) {
            const std::vector<RaySample> ray(64, {.3, opacity_over(x / 255.0, 1.0 / 64)});
            const FixedPixel expected = composite_straight(ray, scene.emulate, dither);
            EXPECT_EQ(image.pixel(x, 2)[0], static_cast<float>(expected.color / 255.0)) << x;
            EXPECT_EQ(image.pixel(x, 2)[3], static_cast<float>(expected.alpha / 255.0)) << x;
        }
    }
}

// In a trilinear field scalars may differ by a unit in their last place, because compilers may fuse
// a product and a sum. That changes a code in at most 255 * 64 * 1e-7 of the pixels; stochastic
// rounding compares with random numbers that are as close.
TEST_F(CpuCodesTest, FieldsMatchTheShadersInNearlyAllCodes) {
    const Volume volume =
        generate({"marschner-lobb", std::array<std::int64_t, 3>{31, 27, 29}, SampleType::uint8});
    const auto several =
        TransferFunction::linear({knot(0, {.1, .9, .3}, 0), knot(90, {.8, .1, .5}, 2),
                                  knot(180, {.3, .6, .2}, 9), knot(255, {1, 1, .9}, 3)});
    const auto one =
        TransferFunction::linear({knot(0, {.1, .9, .3}, 0), knot(255, {1, .2, .9}, 6)});
    for (const auto& [transfer_function, projection] :
         {std::pair(several, Projection::orthographic), std::pair(several, Projection::perspective),
          std::pair(one, Projection::perspective)}) {
        Scene scene = unit_box_scene(transfer_function, projection, 61, 47);
        scene.target = Target::emulated;
        scene.slice.samples = 64;
        for (const auto classification : {Classification::post, Classification::preintegrated}) {
            scene.slice.classification = classification;
            for (const bool dither : {false, true}) {
                scene.slice.dither.reset();
                if (dither) scene.slice.dither = DitherSettings{.period = 16, .color = true};
                for (const AlphaRounding alpha :
                     {AlphaRounding::truncate, AlphaRounding::stochastic}) {
                    scene.emulate.alpha = alpha;
                    const Image tiles = render_tiles(volume, scene);
                    const Image shaders = render(volume, scene, capabilities());
                    EXPECT_LE(differing(tiles, shaders), 61 * 47 * 4 / 500)
                        << name_of(classification) << dither;
                    EXPECT_LE(linf(tiles, shaders), 1.01);
                }
            }
        }
    }
}

// Fragments in float agree to 1e-6, so one that lies on the border between two codes, or two
// halves, sometimes rounds to the other side.
TEST_F(CpuCodesTest, NativeTargetsHoldWhatLlvmpipeBlends) {
    const Volume volume = gaussians(30);
    Scene scene = unit_box_scene(smooth_transfer_function(), Projection::perspective, 61, 47);
    scene.slice.samples = 40;
    for (const Target target : {Target::float16, Target::fixed16, Target::fixed8}) {
        for (const Order order : {Order::back_to_front, Order::front_to_back}) {
            scene.target = target;
            scene.slice.order = order;
            const Image tiles = render_tiles(volume, scene);
            const Image shaders = render(volume, scene, capabilities());
            const double unit = target == Target::fixed8    ? 1
                                : target == Target::fixed16 ? 255. / 65535
                                                            : 255. / 2048;
            EXPECT_LE(linf(tiles, shaders), 2.01 * unit) << name_of(target) << name_of(order);
            const int most = target == Target::fixed8 ? 50 : 2000;
            EXPECT_LE(differing(tiles, shaders), most) << name_of(target) << name_of(order);
        }
    }
}

}  // namespace
}  // namespace lamina
