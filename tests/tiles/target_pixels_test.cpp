// SPDX-License-Identifier: Apache-2.0
// Programmable blending of a tile's planes equals compositing/codes.h bit for bit. Floats hold
// codes exactly.
#include <array>
#include <cmath>
#include <vector>

#include "compositing/codes.h"
#include "tiles/instruction_set_fixture.h"
#include "tiles/vector_functions.h"

namespace lamina {
namespace {

using TargetPixels = EveryInstructionSet;
INSTANTIATE_TEST_SUITE_P(All, TargetPixels, every_instruction_set, instruction_set_name);

constexpr std::uint32_t pixel_count = 1 << 14;

using Planes = std::array<std::vector<float>, 4>;

// Returns random codes; a quarter of them are 0 or the largest code.
Planes random_codes(std::uint32_t largest, std::uint32_t seed) {
    Planes planes;
    for (std::uint32_t channel = 0; channel < 4; ++channel) {
        planes[channel].resize(pixel_count);
        for (std::uint32_t i = 0; i < pixel_count; ++i) {
            const std::uint32_t random = random_bits(i, channel, 0, seed), choice = random >> 29;
            planes[channel][i] = static_cast<float>(choice == 0   ? 0
                                                    : choice == 1 ? largest
                                                                  : random & largest);
        }
    }
    return planes;
}

Planes random_values(std::uint32_t seed) {
    Planes planes = random_codes(0xffff, seed);
    for (std::vector<float>& plane : planes)
        for (float& value : plane) value /= 0xffff;
    return planes;
}

FloatPlanes view(Planes& planes) {
    return {{planes[0], planes[1], planes[2], planes[3]}};
}
ConstFloatPlanes view_const(const Planes& planes) {
    return {{planes[0], planes[1], planes[2], planes[3]}};
}

TargetBlend emulated(int bits) {
    TargetBlend target;
    target.target = Target::emulated;
    target.bits = bits;
    target.largest = static_cast<float>(largest_code(bits));
    return target;
}

std::uint32_t whole_code(float value) {
    return static_cast<std::uint32_t>(value);
}

TEST_P(TargetPixels, CompositesCodesOfEveryLength) {
    for (int bits = 1; bits <= max_code_bits; ++bits) {
        TargetBlend target = emulated(bits);
        const std::uint32_t largest = largest_code(bits);
        const Planes sources = random_codes(largest, 1), before = random_codes(largest, 2);
        for (const Order order : {Order::back_to_front, Order::front_to_back}) {
            for (const OverRounding rounding : {OverRounding::separate, OverRounding::fused}) {
                target.order = order;
                target.over_rounding = rounding;
                const auto expected = [&](std::uint32_t color, std::size_t channel, std::size_t i,
                                          std::size_t alpha_channel) {
                    const std::uint32_t alpha = whole_code(sources[3][i]);
                    const std::uint32_t there = whole_code(before[channel][i]);
                    return order == Order::back_to_front
                               ? over(rounding, color, alpha, there, largest)
                               : under(rounding, color, alpha, there,
                                       whole_code(before[alpha_channel][i]), largest);
                };
                Planes after = before;
                vector_composite_codes(target, view_const(sources), view(after));
                std::vector<float> opacity = before[0];
                vector_composite_opacity(target, sources[3], opacity);
                for (std::size_t i = 0; i < pixel_count; ++i) {
                    for (std::size_t channel = 0; channel < 4; ++channel) {
                        const std::uint32_t color =
                            channel == 3 ? largest : whole_code(sources[channel][i]);
                        ASSERT_EQ(after[channel][i], expected(color, channel, i, 3)) << bits;
                    }
                    ASSERT_EQ(opacity[i], expected(largest, 0, i, 0)) << bits;
                }
            }
        }
    }
}

TEST_P(TargetPixels, RoundsOpacitiesAndColors) {
    const std::vector<float> values = random_values(3)[0];
    std::vector<float> result(pixel_count);
    std::vector<std::uint32_t> random(pixel_count);
    for (std::uint32_t i = 0; i < pixel_count; ++i) random[i] = random_bits(i, 0, 0, 4);
    for (const int bits : {1, 4, 8, 12, 16}) {
        TargetBlend target = emulated(bits);
        const std::uint32_t largest = largest_code(bits);
        for (const AlphaRounding rounding :
             {AlphaRounding::truncate, AlphaRounding::nearest, AlphaRounding::stochastic}) {
            target.alpha_rounding = rounding;
            vector_alpha_code(target, values, random, result);
            for (std::size_t i = 0; i < pixel_count; ++i) {
                const ScaledValue scaled = split_scaled(static_cast<double>(largest) * values[i]);
                ASSERT_EQ(result[i], round_alpha(rounding, scaled, random[i])) << values[i];
            }
        }
        vector_color_code(target, values, result);
        for (std::size_t i = 0; i < pixel_count; ++i)
            ASSERT_EQ(result[i], code_nearest(static_cast<double>(largest) * values[i]));
        const Dither dither{64, 1, false, 3};
        vector_dithered_code(target, dither, 21, values, result);
        for (std::size_t i = 0; i < pixel_count; ++i) {
            ASSERT_EQ(result[i],
                      dither_code(static_cast<double>(largest) * values[i], 21, 64, 3, largest));
        }
    }
}

TEST_P(TargetPixels, CompositesStochastically) {
    std::vector<std::uint32_t> random(pixel_count);
    for (std::uint32_t i = 0; i < pixel_count; ++i) random[i] = random_bits(i, 0, 0, 5);
    const Planes sources = random_values(6);
    for (const int bits : {8, 16}) {
        const std::uint32_t largest = largest_code(bits);
        const Planes before = random_codes(largest, 7);
        Planes after = before;
        vector_composite_stochastic(emulated(bits), view_const(sources), random, view(after));
        for (std::size_t i = 0; i < pixel_count; ++i) {
            for (std::size_t channel = 0; channel < 4; ++channel) {
                ASSERT_EQ(after[channel][i],
                          over_stochastic(sources[channel][i], sources[3][i],
                                          whole_code(before[channel][i]), random[i], largest));
            }
        }
    }
}

TEST(TargetBlendOfPlan, HoldsWhatThePlanSays) {
    CompositingPlan plan;
    EXPECT_EQ(target_blend(plan).largest, 1);
    plan.target = Target::fixed16;
    EXPECT_EQ(target_blend(plan).largest, 65535);
    plan.target = Target::emulated;
    plan.emulation = Emulation{5, AlphaRounding::stochastic, OverRounding::fused, 7};
    plan.order = Order::front_to_back;
    const TargetBlend blend = target_blend(plan);
    EXPECT_EQ(blend.bits, 5);
    EXPECT_EQ(blend.largest, 31);
    EXPECT_EQ(blend.order, Order::front_to_back);
    EXPECT_EQ(blend.alpha_rounding, AlphaRounding::stochastic);
    EXPECT_EQ(blend.over_rounding, OverRounding::fused);
    EXPECT_EQ(blend.seed, 7u);
}

}  // namespace
}  // namespace lamina
