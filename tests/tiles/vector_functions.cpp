// SPDX-License-Identifier: Apache-2.0
#include "tiles/vector_functions.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tiles/vector_functions.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "tiles/node_code-inl.h"
#include "tiles/random_bits-inl.h"
#include "tiles/target_pixels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {
namespace {

using FloatTag = hn::ScalableTag<float>;
using NumberTag = hn::ScalableTag<double>;
using BitTag = hn::ScalableTag<std::uint32_t>;
constexpr FloatTag df;
constexpr NumberTag dn;
constexpr BitTag du;

// result[i] = f(arguments[i] ...), vector by vector.
template <class D, class T, class F, class... Arguments>
void for_vectors(D d, std::span<T> result, F f, const Arguments&... arguments) {
    for (std::size_t i = 0; i < result.size(); i += hn::Lanes(d))
        hn::StoreU(f(hn::LoadU(d, arguments.data() + i)...), d, result.data() + i);
}

hn::Vec<NumberTag> load_bits(const Bits& bits, std::size_t i) {
    alignas(64) double numbers[8];
    for (std::size_t lane = 0; lane < hn::Lanes(dn); ++lane) numbers[lane] = bits[i + lane];
    return hn::Load(dn, numbers);
}

template <class P, class Planes>
P load_planes(const Planes& planes, std::size_t i) {
    return {hn::LoadU(df, planes.planes[0].data() + i), hn::LoadU(df, planes.planes[1].data() + i),
            hn::LoadU(df, planes.planes[2].data() + i), hn::LoadU(df, planes.planes[3].data() + i)};
}

using FloatPixels = Pixels<hn::Vec<FloatTag>>;
using FloatFragment = Fragment<hn::Vec<FloatTag>>;

template <class Source, class F>
void change_planes(const ConstFloatPlanes& sources, FloatPlanes& pixels, F f) {
    for (std::size_t i = 0; i < pixels.planes[0].size(); i += hn::Lanes(df)) {
        FloatPixels there = load_planes<FloatPixels>(pixels, i);
        f(load_planes<Source>(sources, i), there, i);
        hn::StoreU(there.red, df, pixels.planes[0].data() + i);
        hn::StoreU(there.green, df, pixels.planes[1].data() + i);
        hn::StoreU(there.blue, df, pixels.planes[2].data() + i);
        hn::StoreU(there.alpha, df, pixels.planes[3].data() + i);
    }
}

template <class F>
void change_plane(Floats sources, std::span<float> pixels, F f) {
    for (std::size_t i = 0; i < pixels.size(); i += hn::Lanes(df)) {
        auto there = hn::LoadU(df, pixels.data() + i);
        f(hn::LoadU(df, sources.data() + i), there);
        hn::StoreU(there, df, pixels.data() + i);
    }
}

int lanes() {
    return static_cast<int>(hn::Lanes(df));
}

void exp_floats(Floats x, std::span<float> result) {
    for_vectors(
        df, result, [](auto v) HWY_ATTR { return exp_of(df, v); }, x);
}
void log_floats(Floats x, std::span<float> result) {
    for_vectors(
        df, result, [](auto v) HWY_ATTR { return log_of(df, v); }, x);
}
void opacity_floats(Floats depth, std::span<float> result) {
    for_vectors(
        df, result, [](auto v) HWY_ATTR { return opacity_from_depth(df, v); }, depth);
}
void opacity_numbers(Numbers depth, std::span<double> result) {
    for_vectors(
        dn, result, [](auto v) HWY_ATTR { return opacity_from_depth(dn, v); }, depth);
}
void encode(NodeCode code, float share, Floats depth, std::span<float> result) {
    const auto f = [=](auto v) HWY_ATTR { return encode_depth(df, code, v, share); };
    for_vectors(df, result, f, depth);
}
void decode(NodeCode code, float share, Floats value, std::span<float> result) {
    const auto f = [=](auto v) HWY_ATTR { return decode_depth(df, code, v, share); };
    for_vectors(df, result, f, value);
}

void over_numbers(OverRounding rounding, double largest, const CodeOperands& codes,
                  std::span<double> result) {
    const auto f = [=](auto color, auto alpha, auto below)
                       HWY_ATTR { return over(dn, rounding, color, alpha, below, largest); };
    for_vectors(dn, result, f, codes.color, codes.alpha, codes.below);
}
void under_numbers(OverRounding rounding, double largest, const CodeOperands& codes,
                   std::span<double> result) {
    const auto f = [=](auto color, auto alpha, auto above, auto above_alpha) HWY_ATTR {
        return under(dn, rounding, color, alpha, above, above_alpha, largest);
    };
    for_vectors(dn, result, f, codes.color, codes.alpha, codes.below, codes.above_alpha);
}
void nearest_numbers(Numbers scaled, std::span<double> result) {
    for_vectors(
        dn, result, [](auto v) HWY_ATTR { return code_nearest(dn, v); }, scaled);
}
void round_numbers(AlphaRounding rounding, Numbers scaled, Bits random, std::span<double> result) {
    for (std::size_t i = 0; i < result.size(); i += hn::Lanes(dn)) {
        const auto value = split_scaled(dn, hn::LoadU(dn, scaled.data() + i));
        hn::StoreU(round_alpha(dn, rounding, value, load_bits(random, i)), dn, result.data() + i);
    }
}
void dither_numbers(double largest, int period, int increment, Numbers scaled, Bits rank,
                    std::span<double> result) {
    for (std::size_t i = 0; i < result.size(); ++i) {
        const auto value = hn::Set(dn, scaled[i]);
        result[i] = hn::GetLane(dither_code(dn, value, rank[i], period, increment, largest));
    }
}
void stochastic_numbers(double largest, Numbers source, Numbers alpha, Numbers below, Bits random,
                        std::span<double> result) {
    for (std::size_t i = 0; i < result.size(); i += hn::Lanes(dn)) {
        const auto codes =
            over_stochastic(dn, hn::LoadU(dn, source.data() + i), hn::LoadU(dn, alpha.data() + i),
                            hn::LoadU(dn, below.data() + i), load_bits(random, i), largest);
        hn::StoreU(codes, dn, result.data() + i);
    }
}
void random_numbers(Bits column, Bits row, Bits sample, std::uint32_t seed,
                    std::span<std::uint32_t> result) {
    const auto f = [=](auto c, auto r, auto s)
                       HWY_ATTR { return random_bits(du, c, r, s, hn::Set(du, seed)); };
    for_vectors(du, result, f, column, row, sample);
}

void blend_planes(const TargetBlend& target, const ConstFloatPlanes& fragments,
                  FloatPlanes pixels) {
    const auto f = [&](const auto& source, auto& there, std::size_t)
                       HWY_ATTR { blend(df, target, source, there); };
    change_planes<FloatFragment>(fragments, pixels, f);
}
void blend_plane(const TargetBlend& target, Floats opacity, std::span<float> pixels) {
    const auto f = [&](auto source, auto& there)
                       HWY_ATTR { blend_opacity(df, target, source, there); };
    change_plane(opacity, pixels, f);
}
void composite_planes(const TargetBlend& target, const ConstFloatPlanes& codes,
                      FloatPlanes pixels) {
    const auto f = [&](const auto& source, auto& there, std::size_t)
                       HWY_ATTR { composite_codes(df, target, source, there); };
    change_planes<FloatPixels>(codes, pixels, f);
}
void composite_plane(const TargetBlend& target, Floats alpha, std::span<float> pixels) {
    const auto f = [&](auto source, auto& there)
                       HWY_ATTR { composite_opacity(df, target, source, there); };
    change_plane(alpha, pixels, f);
}
void stochastic_planes(const TargetBlend& target, const ConstFloatPlanes& fragments, Bits random,
                       FloatPlanes pixels) {
    const auto f = [&](const auto& source, auto& there, std::size_t i) HWY_ATTR {
        composite_stochastic(df, target, source, hn::LoadU(du, random.data() + i), there);
    };
    change_planes<FloatFragment>(fragments, pixels, f);
}
void alpha_codes(const TargetBlend& target, Floats opacity, Bits random, std::span<float> result) {
    for (std::size_t i = 0; i < result.size(); i += hn::Lanes(df)) {
        const auto values = to_doubles(df, hn::LoadU(df, opacity.data() + i));
        const auto bits = hn::LoadU(du, random.data() + i);
        hn::StoreU(alpha_code(df, target, values, bits), df, result.data() + i);
    }
}
void dithered_codes(const TargetBlend& target, const Dither& dither, std::uint32_t rank,
                    Floats value, std::span<float> result) {
    const auto f = [&](auto v) HWY_ATTR {
        return dithered_code(df, target, to_doubles(df, v), dither, rank);
    };
    for_vectors(df, result, f, value);
}
void color_codes(const TargetBlend& target, Floats color, std::span<float> result) {
    const auto f = [&](auto v) HWY_ATTR { return color_code(df, target, v); };
    for_vectors(df, result, f, color);
}

}  // namespace
}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lamina {

#define LAMINA_DISPATCH(name, function, parameters, arguments) \
    HWY_EXPORT(function);                                      \
    void name parameters {                                     \
        HWY_DYNAMIC_DISPATCH(function) arguments;              \
    }

HWY_EXPORT(lanes);
int vector_lanes() {
    return HWY_DYNAMIC_DISPATCH(lanes)();
}

LAMINA_DISPATCH(vector_exp, exp_floats, (Floats x, std::span<float> result), (x, result))
LAMINA_DISPATCH(vector_log, log_floats, (Floats x, std::span<float> result), (x, result))
LAMINA_DISPATCH(vector_opacity, opacity_floats, (Floats depth, std::span<float> result),
                (depth, result))
LAMINA_DISPATCH(vector_opacity, opacity_numbers, (Numbers depth, std::span<double> result),
                (depth, result))
LAMINA_DISPATCH(vector_encode, encode,
                (NodeCode code, float share, Floats depth, std::span<float> result),
                (code, share, depth, result))
LAMINA_DISPATCH(vector_decode, decode,
                (NodeCode code, float share, Floats value, std::span<float> result),
                (code, share, value, result))
LAMINA_DISPATCH(vector_over, over_numbers,
                (OverRounding rounding, double largest, const CodeOperands& codes,
                 std::span<double> result),
                (rounding, largest, codes, result))
LAMINA_DISPATCH(vector_under, under_numbers,
                (OverRounding rounding, double largest, const CodeOperands& codes,
                 std::span<double> result),
                (rounding, largest, codes, result))
LAMINA_DISPATCH(vector_code_nearest, nearest_numbers, (Numbers scaled, std::span<double> result),
                (scaled, result))
LAMINA_DISPATCH(vector_round_alpha, round_numbers,
                (AlphaRounding rounding, Numbers scaled, Bits random, std::span<double> result),
                (rounding, scaled, random, result))
LAMINA_DISPATCH(vector_dither, dither_numbers,
                (double largest, int period, int increment, Numbers scaled, Bits rank,
                 std::span<double> result),
                (largest, period, increment, scaled, rank, result))
LAMINA_DISPATCH(vector_over_stochastic, stochastic_numbers,
                (double largest, Numbers source, Numbers alpha, Numbers below, Bits random,
                 std::span<double> result),
                (largest, source, alpha, below, random, result))
LAMINA_DISPATCH(vector_random_bits, random_numbers,
                (Bits column, Bits row, Bits sample, std::uint32_t seed,
                 std::span<std::uint32_t> result),
                (column, row, sample, seed, result))
LAMINA_DISPATCH(vector_blend, blend_planes,
                (const TargetBlend& target, const ConstFloatPlanes& fragments, FloatPlanes pixels),
                (target, fragments, pixels))
LAMINA_DISPATCH(vector_blend_opacity, blend_plane,
                (const TargetBlend& target, Floats opacity, std::span<float> pixels),
                (target, opacity, pixels))
LAMINA_DISPATCH(vector_composite_codes, composite_planes,
                (const TargetBlend& target, const ConstFloatPlanes& codes, FloatPlanes pixels),
                (target, codes, pixels))
LAMINA_DISPATCH(vector_composite_opacity, composite_plane,
                (const TargetBlend& target, Floats alpha, std::span<float> pixels),
                (target, alpha, pixels))
LAMINA_DISPATCH(vector_composite_stochastic, stochastic_planes,
                (const TargetBlend& target, const ConstFloatPlanes& fragments, Bits random,
                 FloatPlanes pixels),
                (target, fragments, random, pixels))
LAMINA_DISPATCH(vector_alpha_code, alpha_codes,
                (const TargetBlend& target, Floats opacity, Bits random, std::span<float> result),
                (target, opacity, random, result))
LAMINA_DISPATCH(vector_dithered_code, dithered_codes,
                (const TargetBlend& target, const Dither& dither, std::uint32_t rank, Floats value,
                 std::span<float> result),
                (target, dither, rank, value, result))
LAMINA_DISPATCH(vector_color_code, color_codes,
                (const TargetBlend& target, Floats color, std::span<float> result),
                (target, color, result))

#undef LAMINA_DISPATCH

}  // namespace lamina
#endif
