// SPDX-License-Identifier: Apache-2.0
#include "tiles/vector_functions.h"

#undef LAMINA_TARGET_FILE
#define LAMINA_TARGET_FILE "tiles/vector_functions.cpp"
#include "simd/foreach_target.h"

#include "tiles/node_code-inl.h"
#include "tiles/target_pixels-inl.h"

LAMINA_SIMD_BEGIN
namespace {

// Sets result[i] to f(arguments[i] ...), vector by vector.
template <class V, class F, class... Arguments>
void for_vectors(std::span<typename V::Scalar> result, F f, const Arguments&... arguments) {
    for (std::size_t i = 0; i < result.size(); i += V::lanes)
        store_unaligned(f(load_unaligned<V>(arguments.data() + i)...), result.data() + i);
}

Double load_bits(const Bits& bits, std::size_t i) {
    alignas(64) double numbers[8];
    for (std::size_t lane = 0; lane < Double::lanes; ++lane) numbers[lane] = bits[i + lane];
    return load<Double>(numbers);
}

template <class P, class Planes>
P load_planes(const Planes& planes, std::size_t i) {
    const auto plane = [&](std::size_t channel) LAMINA_LAMBDA {
        return load_unaligned<Float>(planes.planes[channel].data() + i);
    };
    return {plane(0), plane(1), plane(2), plane(3)};
}

template <class Source, class F>
void change_planes(const ConstFloatPlanes& sources, FloatPlanes& pixels, F f) {
    for (std::size_t i = 0; i < pixels.planes[0].size(); i += Float::lanes) {
        Pixels there = load_planes<Pixels>(pixels, i);
        f(load_planes<Source>(sources, i), there, i);
        store_unaligned(there.red, pixels.planes[0].data() + i);
        store_unaligned(there.green, pixels.planes[1].data() + i);
        store_unaligned(there.blue, pixels.planes[2].data() + i);
        store_unaligned(there.alpha, pixels.planes[3].data() + i);
    }
}

template <class F>
void change_plane(Floats sources, std::span<float> pixels, F f) {
    for (std::size_t i = 0; i < pixels.size(); i += Float::lanes) {
        Float there = load_unaligned<Float>(pixels.data() + i);
        f(load_unaligned<Float>(sources.data() + i), there);
        store_unaligned(there, pixels.data() + i);
    }
}

int lanes() {
    return static_cast<int>(Float::lanes);
}

void exp_floats(Floats x, std::span<float> result) {
    for_vectors<Float>(
        result, [](auto v) LAMINA_LAMBDA { return exp_of(v); }, x);
}
void log_floats(Floats x, std::span<float> result) {
    for_vectors<Float>(
        result, [](auto v) LAMINA_LAMBDA { return log_of(v); }, x);
}
void opacity_floats(Floats depth, std::span<float> result) {
    for_vectors<Float>(
        result, [](auto v) LAMINA_LAMBDA { return opacity_from_depth(v); }, depth);
}
void opacity_numbers(Numbers depth, std::span<double> result) {
    for_vectors<Double>(
        result, [](auto v) LAMINA_LAMBDA { return opacity_from_depth(v); }, depth);
}
void encode(NodeCode code, float share, Floats depth, std::span<float> result) {
    const auto f = [=](auto v) LAMINA_LAMBDA { return encode_depth(code, v, share); };
    for_vectors<Float>(result, f, depth);
}
void decode(NodeCode code, float share, Floats value, std::span<float> result) {
    const auto f = [=](auto v) LAMINA_LAMBDA { return decode_depth(code, v, share); };
    for_vectors<Float>(result, f, value);
}

void over_numbers(OverRounding rounding, double largest, const CodeOperands& codes,
                  std::span<double> result) {
    const auto f = [=](auto color, auto alpha, auto below)
                       LAMINA_LAMBDA { return over(rounding, color, alpha, below, largest); };
    for_vectors<Double>(result, f, codes.color, codes.alpha, codes.below);
}
void under_numbers(OverRounding rounding, double largest, const CodeOperands& codes,
                   std::span<double> result) {
    const auto f = [=](auto color, auto alpha, auto above, auto above_alpha) LAMINA_LAMBDA {
        return under(rounding, color, alpha, above, above_alpha, largest);
    };
    for_vectors<Double>(result, f, codes.color, codes.alpha, codes.below, codes.above_alpha);
}
void nearest_numbers(Numbers scaled, std::span<double> result) {
    for_vectors<Double>(
        result, [](auto v) LAMINA_LAMBDA { return code_nearest(v); }, scaled);
}
void round_numbers(AlphaRounding rounding, Numbers scaled, Bits random, std::span<double> result) {
    for (std::size_t i = 0; i < result.size(); i += Double::lanes) {
        const auto value = split_scaled(load_unaligned<Double>(scaled.data() + i));
        store_unaligned(round_alpha(rounding, value, load_bits(random, i)), result.data() + i);
    }
}
void dither_numbers(double largest, int period, int increment, Numbers scaled, Bits rank,
                    std::span<double> result) {
    for (std::size_t i = 0; i < result.size(); ++i) {
        const auto value = Double(scaled[i]);
        result[i] = first_of(dither_code(value, rank[i], period, increment, largest));
    }
}
void stochastic_numbers(double largest, Numbers source, Numbers alpha, Numbers below, Bits random,
                        std::span<double> result) {
    for (std::size_t i = 0; i < result.size(); i += Double::lanes) {
        const auto codes = over_stochastic(
            load_unaligned<Double>(source.data() + i), load_unaligned<Double>(alpha.data() + i),
            load_unaligned<Double>(below.data() + i), load_bits(random, i), largest);
        store_unaligned(codes, result.data() + i);
    }
}
void random_numbers(Bits column, Bits row, Bits sample, std::uint32_t seed,
                    std::span<std::uint32_t> result) {
    const auto f = [=](auto c, auto r, auto s)
                       LAMINA_LAMBDA { return random_bits(c, r, s, Word(seed)); };
    for_vectors<Word>(result, f, column, row, sample);
}

void blend_planes(const TargetBlend& target, const ConstFloatPlanes& fragments,
                  FloatPlanes pixels) {
    const auto f = [&](const auto& source, auto& there, std::size_t)
                       LAMINA_LAMBDA { blend(target, source, there); };
    change_planes<Fragment>(fragments, pixels, f);
}
void blend_plane(const TargetBlend& target, Floats opacity, std::span<float> pixels) {
    const auto f = [&](auto source, auto& there)
                       LAMINA_LAMBDA { blend_opacity(target, source, there); };
    change_plane(opacity, pixels, f);
}
void composite_planes(const TargetBlend& target, const ConstFloatPlanes& codes,
                      FloatPlanes pixels) {
    const auto f = [&](const auto& source, auto& there, std::size_t)
                       LAMINA_LAMBDA { composite_codes(target, source, there); };
    change_planes<Pixels>(codes, pixels, f);
}
void composite_plane(const TargetBlend& target, Floats alpha, std::span<float> pixels) {
    const auto f = [&](auto source, auto& there)
                       LAMINA_LAMBDA { composite_opacity(target, source, there); };
    change_plane(alpha, pixels, f);
}
void stochastic_planes(const TargetBlend& target, const ConstFloatPlanes& fragments, Bits random,
                       FloatPlanes pixels) {
    const auto f = [&](const auto& source, auto& there, std::size_t i) LAMINA_LAMBDA {
        composite_stochastic(target, source, load_unaligned<Word>(random.data() + i), there);
    };
    change_planes<Fragment>(fragments, pixels, f);
}
void alpha_codes(const TargetBlend& target, Floats opacity, Bits random, std::span<float> result) {
    for (std::size_t i = 0; i < result.size(); i += Float::lanes) {
        const Float64 values(load_unaligned<Float>(opacity.data() + i));
        const auto bits = load_unaligned<Word>(random.data() + i);
        store_unaligned(alpha_code(target, values, bits), result.data() + i);
    }
}
void dithered_codes(const TargetBlend& target, const Dither& dither, std::uint32_t rank,
                    Floats value, std::span<float> result) {
    const auto f = [&](auto v)
                       LAMINA_LAMBDA { return dithered_code(target, Float64(v), dither, rank); };
    for_vectors<Float>(result, f, value);
}
void color_codes(const TargetBlend& target, Floats color, std::span<float> result) {
    const auto f = [&](auto v) LAMINA_LAMBDA { return color_code(target, v); };
    for_vectors<Float>(result, f, color);
}

}  // namespace
LAMINA_SIMD_END

#if LAMINA_ONCE
namespace lamina {

#define LAMINA_VECTOR_FUNCTION(name, function, parameters, arguments) \
    LAMINA_EXPORT(function);                                          \
    void name parameters {                                            \
        LAMINA_DISPATCH(function) arguments;                          \
    }

LAMINA_EXPORT(lanes);
int vector_lanes() {
    return LAMINA_DISPATCH(lanes)();
}

LAMINA_VECTOR_FUNCTION(vector_exp, exp_floats, (Floats x, std::span<float> result), (x, result))
LAMINA_VECTOR_FUNCTION(vector_log, log_floats, (Floats x, std::span<float> result), (x, result))
LAMINA_VECTOR_FUNCTION(vector_opacity, opacity_floats, (Floats depth, std::span<float> result),
                       (depth, result))
LAMINA_VECTOR_FUNCTION(vector_opacity, opacity_numbers, (Numbers depth, std::span<double> result),
                       (depth, result))
LAMINA_VECTOR_FUNCTION(vector_encode, encode,
                       (NodeCode code, float share, Floats depth, std::span<float> result),
                       (code, share, depth, result))
LAMINA_VECTOR_FUNCTION(vector_decode, decode,
                       (NodeCode code, float share, Floats value, std::span<float> result),
                       (code, share, value, result))
LAMINA_VECTOR_FUNCTION(vector_over, over_numbers,
                       (OverRounding rounding, double largest, const CodeOperands& codes,
                        std::span<double> result),
                       (rounding, largest, codes, result))
LAMINA_VECTOR_FUNCTION(vector_under, under_numbers,
                       (OverRounding rounding, double largest, const CodeOperands& codes,
                        std::span<double> result),
                       (rounding, largest, codes, result))
LAMINA_VECTOR_FUNCTION(vector_code_nearest, nearest_numbers,
                       (Numbers scaled, std::span<double> result), (scaled, result))
LAMINA_VECTOR_FUNCTION(vector_round_alpha, round_numbers,
                       (AlphaRounding rounding, Numbers scaled, Bits random,
                        std::span<double> result),
                       (rounding, scaled, random, result))
LAMINA_VECTOR_FUNCTION(vector_dither, dither_numbers,
                       (double largest, int period, int increment, Numbers scaled, Bits rank,
                        std::span<double> result),
                       (largest, period, increment, scaled, rank, result))
LAMINA_VECTOR_FUNCTION(vector_over_stochastic, stochastic_numbers,
                       (double largest, Numbers source, Numbers alpha, Numbers below, Bits random,
                        std::span<double> result),
                       (largest, source, alpha, below, random, result))
LAMINA_VECTOR_FUNCTION(vector_random_bits, random_numbers,
                       (Bits column, Bits row, Bits sample, std::uint32_t seed,
                        std::span<std::uint32_t> result),
                       (column, row, sample, seed, result))
LAMINA_VECTOR_FUNCTION(vector_blend, blend_planes,
                       (const TargetBlend& target, const ConstFloatPlanes& fragments,
                        FloatPlanes pixels),
                       (target, fragments, pixels))
LAMINA_VECTOR_FUNCTION(vector_blend_opacity, blend_plane,
                       (const TargetBlend& target, Floats opacity, std::span<float> pixels),
                       (target, opacity, pixels))
LAMINA_VECTOR_FUNCTION(vector_composite_codes, composite_planes,
                       (const TargetBlend& target, const ConstFloatPlanes& codes,
                        FloatPlanes pixels),
                       (target, codes, pixels))
LAMINA_VECTOR_FUNCTION(vector_composite_opacity, composite_plane,
                       (const TargetBlend& target, Floats alpha, std::span<float> pixels),
                       (target, alpha, pixels))
LAMINA_VECTOR_FUNCTION(vector_composite_stochastic, stochastic_planes,
                       (const TargetBlend& target, const ConstFloatPlanes& fragments, Bits random,
                        FloatPlanes pixels),
                       (target, fragments, random, pixels))
LAMINA_VECTOR_FUNCTION(vector_alpha_code, alpha_codes,
                       (const TargetBlend& target, Floats opacity, Bits random,
                        std::span<float> result),
                       (target, opacity, random, result))
LAMINA_VECTOR_FUNCTION(vector_dithered_code, dithered_codes,
                       (const TargetBlend& target, const Dither& dither, std::uint32_t rank,
                        Floats value, std::span<float> result),
                       (target, dither, rank, value, result))
LAMINA_VECTOR_FUNCTION(vector_color_code, color_codes,
                       (const TargetBlend& target, Floats color, std::span<float> result),
                       (target, color, result))

#undef LAMINA_VECTOR_FUNCTION

}  // namespace lamina
#endif
