// SPDX-License-Identifier: Apache-2.0
// The emulated target holds, code for code, what src/compositing computes for each ray on the
// processor.
#include "compositing/codes.h"
#include "compositing/fixed_ray.h"
#include "ramp_scene.h"
#include "volume/generate.h"

namespace lamina {
namespace {

struct EmulatedCase {
    Emulation emulation;
    Order order = Order::back_to_front;
    std::optional<Dither> dither;
    std::vector<int> factors;
    double color = 1;
};

class EmulatedTest : public SlicingTest {
  protected:
    Volume volume_ = generate({"ramp", {}, SampleType::uint8});

    void compare(const EmulatedCase& wanted, int samples) {
        Scene scene = ramp_scene(glm::dvec3(wanted.color));
        scene.slice.samples = samples;
        scene.slice.order = wanted.order;
        scene.emulate = wanted.emulation;
        if (wanted.dither) {
            const Dither& dither = *wanted.dither;
            scene.slice.dither =
                DitherSettings{dither.period, dither.seed, dither.color, dither.increment};
        }
        if (!wanted.factors.empty()) {
            scene.slice.tree =
                TreeSettings{.factors = wanted.factors, .nodes = NodeArithmetic::fixed};
        }
        const Image image = render(volume_, scene, capabilities());
        const auto largest = static_cast<double>(largest_code(wanted.emulation.bits));
        for (int y = 0; y < ramp_height; ++y) {
            for (int x = 0; x < ramp_width; ++x) {
                const FixedPixel expected = composite(wanted, samples, x, y);
                const float* const pixel = image.pixel(x, y);
                ASSERT_EQ(pixel[0], static_cast<float>(expected.color / largest)) << x << " " << y;
                ASSERT_EQ(pixel[3], static_cast<float>(expected.alpha / largest)) << x << " " << y;
            }
        }
    }

  private:
    static FixedPixel composite(const EmulatedCase& wanted, int samples, int x, int y) {
        const double opacity = x / 255.0;
        const auto column = static_cast<std::uint32_t>(x), row = static_cast<std::uint32_t>(y);
        const auto count = static_cast<std::size_t>(samples);
        if (wanted.factors.empty()) {
            const std::vector<RaySample> ray(count,
                                             {wanted.color, opacity_over(opacity, 1.0 / samples)});
            return composite_straight(ray, wanted.emulation, wanted.dither, wanted.order, column,
                                      row);
        }
        const std::vector<double> ray(count, opacity);
        const std::uint32_t alpha =
            composite_tree(ray, TreeShape(wanted.factors, samples), wanted.emulation, wanted.dither,
                           wanted.order, column, row);
        const std::uint32_t largest = largest_code(wanted.emulation.bits);
        return {divide_nearest(code_nearest(largest * wanted.color) * alpha, largest), alpha};
    }
};

TEST_F(EmulatedTest, StraightCompositingMatchesTheFixedPointSimulation) {
    for (const int bits : {1, 4, 8, 12, 16}) {
        for (const AlphaRounding alpha :
             {AlphaRounding::truncate, AlphaRounding::nearest, AlphaRounding::stochastic}) {
            for (const OverRounding over : {OverRounding::separate, OverRounding::fused}) {
                for (const Order order : {Order::back_to_front, Order::front_to_back}) {
                    compare({{bits, alpha, over, 99}, order, {}, {}, .5}, 64);
                    if (HasFatalFailure()) FAIL() << bits << " bits";
                }
            }
        }
    }
}

TEST_F(EmulatedTest, DitheringMatchesTheFixedPointSimulation) {
    for (const bool color : {false, true}) {
        for (const int increment : {1, 4, 8}) {
            EmulatedCase wanted;
            wanted.dither = Dither{11, 5, color, increment};
            wanted.color = .3;
            compare(wanted, 64);
            wanted.order = Order::front_to_back;
            compare(wanted, 64);
        }
    }
}

TEST_F(EmulatedTest, TreesMatchTheFixedPointSimulation) {
    for (const int bits : {4, 8, 16}) {
        for (const AlphaRounding alpha : {AlphaRounding::nearest, AlphaRounding::stochastic}) {
            for (const std::vector<int>& factors :
                 {std::vector<int>{5, 3}, {1, 4, 4}, {100}, {3, 2, 3, 2}}) {
                for (const Order order : {Order::back_to_front, Order::front_to_back}) {
                    compare({{bits, alpha, OverRounding::fused, 7}, order, {}, factors, .5}, 50);
                    if (HasFatalFailure()) FAIL() << bits << " bits, " << to_text(factors);
                }
            }
        }
    }
}

}  // namespace
}  // namespace lamina
