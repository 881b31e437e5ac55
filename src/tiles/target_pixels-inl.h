// SPDX-License-Identifier: Apache-2.0
// How a target composites fragments. Functions take and return vectors of a tile's planes
// (tiles/tile_image.h). Vector forms of compositing/codes.h and compositing/codes.h, bit for bit.
#if defined(LAMINA_TILES_TARGET_PIXELS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_TILES_TARGET_PIXELS_INL_H_
#undef LAMINA_TILES_TARGET_PIXELS_INL_H_
#else
#define LAMINA_TILES_TARGET_PIXELS_INL_H_
#endif

#include "base/enum_words.h"
#include "compositing/codes.h"
#include "simd/vectors-inl.h"
#include "tiles/tile_image.h"

LAMINA_SIMD_BEGIN

// Bits up to which OVER and UNDER may compute in floats. The rounded sum, up to M^2 + M / 2, is
// exact in the 24 bits of a float for M < 2^12. Its quotient by M is below 2^12 and so rounded by
// less than 2^-12. It cannot reach the next whole number, which is at least 1 / M away. For fused
// UNDER the numbers are M^3 + M^2 / 2 and 1 / M^2, so M < 2^8. Doubles hold the 49 bits of M < 2^16
// and round quotients by less than 2^-37.
inline constexpr int max_float_over_bits = 12;
inline constexpr int max_float_under_bits = 8;

// Rounds x / n to the nearest whole number; n is odd.
template <class V>
LAMINA_INLINE V divide_nearest(V x, typename V::Scalar n) {
    return floor((x + (n - 1) / 2) / n);
}

template <class V>
LAMINA_INLINE V over(OverRounding rounding, V color, V alpha, V below, typename V::Scalar largest) {
    const V source = color * alpha;
    const V kept = below * (largest - alpha);
    return rounding == OverRounding::fused
               ? divide_nearest(source + kept, largest)
               : divide_nearest(source, largest) + divide_nearest(kept, largest);
}

template <class V>
LAMINA_INLINE V under(OverRounding rounding, V color, V alpha, V above, V above_alpha,
                      typename V::Scalar largest) {
    const V left = largest - above_alpha;
    const V product = color * alpha;
    if (rounding == OverRounding::separate) {
        const V source = divide_nearest(product, largest);
        return above + divide_nearest(source * left, largest);
    }
    return above + divide_nearest(product * left, largest * largest);
}

template <class V>
struct ScaledValues {
    V whole, rest;
};

template <class V>
LAMINA_INLINE ScaledValues<V> split_scaled(V scaled) {
    const V whole = floor(scaled + code_noise);
    return {whole, max(scaled - whole, 0)};
}

template <class V>
LAMINA_INLINE V code_nearest(V scaled) {
    return floor(scaled + 0.5);
}

// Returns `code`, or the next code if `up`.
template <class V>
LAMINA_INLINE V step_up(V code, typename V::Mask up) {
    return code + zero_unless(up, V(1.0));
}

// `random`: 32 random bits as a number, for stochastic rounding only.
template <class V>
LAMINA_INLINE V round_alpha(AlphaRounding rounding, const ScaledValues<V>& scaled, V random) {
    switch (rounding) {
        case AlphaRounding::truncate:
            return scaled.whole;
        case AlphaRounding::nearest:
            return step_up(scaled.whole, scaled.rest + code_noise >= 0.5);
        case AlphaRounding::stochastic:
            return step_up(scaled.whole, random < scaled.rest * 0x1p32);
    }
    unreachable_enum();
}

template <class V>
LAMINA_INLINE V dither_code(V scaled, double rank, int period, int increment, double largest) {
    const double step = increment;
    const ScaledValues<V> value = split_scaled(scaled / step);
    const V terms = floor(static_cast<double>(period) * value.rest + code_noise);
    const V steps = step_up(value.whole, rank < terms);
    return select(scaled >= largest - code_noise, largest, min(steps * step, largest));
}

template <class V>
LAMINA_INLINE V over_stochastic(V source, V alpha, V below, V random, double largest) {
    const ScaledValues<V> value = split_scaled(largest * source + below * (1.0 - alpha));
    return min(step_up(value.whole, random < value.rest * 0x1p32), largest);
}

LAMINA_INLINE Word random_bits(Word column, Word row, Word sample, Word seed) {
    const auto spread = [](Word v) LAMINA_LAMBDA { return v * 1664525u + 1013904223u; };
    Word x = spread(column), y = spread(row), z = spread(sample), w = spread(seed);
    const auto mix_all = [&] LAMINA_LAMBDA {
        x += y * w;
        y += z * x;
        z += x * y;
        w += y * z;
    };
    mix_all();
    x = x ^ shift_right<16>(x);
    y = y ^ shift_right<16>(y);
    z = z ^ shift_right<16>(z);
    w = w ^ shift_right<16>(w);
    mix_all();
    return w;
}

static_assert(TileGrid::block == 4);

// Returns random bits for the pixels of a vector, 4 x 1, 4 x 2 or 4 x 4 of a tile. Its first pixel
// is (column, row) of the picture, rows from the top.
LAMINA_INLINE Word random_of_pixels(int column, int row, std::uint32_t sample, std::uint32_t seed) {
    const Word lanes = iota<Word>(0);
    return random_bits(static_cast<std::uint32_t>(column) + (lanes & 3u),
                       static_cast<std::uint32_t>(row) + shift_right<2>(lanes), Word(sample),
                       Word(seed));
}

// The associated colour and the opacity of a vector of pixels, or of fragments.
struct Pixels {
    Float red, green, blue, alpha;
};
using Fragment = Pixels;

// Rounds towards zero to half precision, as llvmpipe stores floats. Below 2^-14 the last place is
// 2^-24.
LAMINA_INLINE Float truncate_to_half(Float v) {
    const Float normal = bits_as<Float>(bits_as<Word>(v) & ~0x1fffu);
    const Float small = trunc(v * 0x1p24f) * 0x1p-24f;
    const Float half = select(abs(v) < 0x1p-14f, small, normal);
    return min(half, 65504.0f);
}

// The product of two codes of `bits` bits as the blending unit of llvmpipe rounds it.
LAMINA_INLINE Float multiply_codes(int bits, Float a, Float b) {
    if (bits == 8) {
        constexpr float step = 1.0f / 256;
        const Float product = a * b;
        const Float sum = product + floor(product * step);
        return floor((sum + 128.0f) * step);
    }
    const Word product = bits_as<Word>(to_int(a)) * bits_as<Word>(to_int(b));
    const Word sum = product + shift_right<16>(product);
    const Word code = shift_right<16>(sum + 0x8000u);
    return to_float(bits_as<Int>(code));
}

LAMINA_INLINE Float native_code(float largest, Float value) {
    return round(clamp01(value) * largest);
}

// Blends one channel. `kept`: the share of the pixel that the source leaves visible or, front to
// back, the share of the source that the pixel leaves visible.
LAMINA_INLINE void blend_channel(const TargetBlend& target, Float source, Float kept,
                                 Float& there) {
    const bool behind = target.order == Order::front_to_back;
    if (is_fixed_point(target.target)) {
        const Float product = multiply_codes(target.bits, behind ? source : there, kept);
        const Float sum = product + (behind ? there : source);
        there = min(sum, target.largest);
        return;
    }
    const Float sum = behind ? source * kept + there : there * kept + source;
    there = target.target == Target::float16 ? truncate_to_half(sum) : sum;
}

// Computes what the blending unit of a float32, float16, fixed8 or fixed16 target computes: source
// + there (1 - source alpha), or front to back there + source (1 - there alpha). Fixed-point
// targets round the fragment to codes first, and then the product. All rounding is that of
// llvmpipe.
LAMINA_INLINE void blend(const TargetBlend& target, const Fragment& fragment, Pixels& there) {
    Fragment source = fragment;
    if (is_fixed_point(target.target)) {
        source.red = native_code(target.largest, source.red);
        source.green = native_code(target.largest, source.green);
        source.blue = native_code(target.largest, source.blue);
        source.alpha = native_code(target.largest, source.alpha);
    }
    const Float kept =
        target.largest - (target.order == Order::front_to_back ? there.alpha : source.alpha);
    blend_channel(target, source.red, kept, there.red);
    blend_channel(target, source.green, kept, there.green);
    blend_channel(target, source.blue, kept, there.blue);
    blend_channel(target, source.alpha, kept, there.alpha);
}

LAMINA_INLINE void blend_opacity(const TargetBlend& target, Float opacity, Float& there) {
    const Float source =
        is_fixed_point(target.target) ? native_code(target.largest, opacity) : opacity;
    const Float kept = target.largest - (target.order == Order::front_to_back ? there : source);
    blend_channel(target, source, kept, there);
}

// OVER or UNDER of one channel, in floats if they are precise enough.
LAMINA_INLINE Float composite_channel(const TargetBlend& target, Float color, Float alpha,
                                      Float there, Float there_alpha) {
    const bool behind = target.order == Order::front_to_back;
    const int float_bits = behind && target.over_rounding == OverRounding::fused
                               ? max_float_under_bits
                               : max_float_over_bits;
    const auto one_channel = [&](auto c, auto a, auto t, auto ta) LAMINA_LAMBDA {
        const auto largest = static_cast<typename decltype(c)::Scalar>(target.largest);
        return behind ? under(target.over_rounding, c, a, t, ta, largest)
                      : over(target.over_rounding, c, a, t, largest);
    };
    if (target.bits <= float_bits) return one_channel(color, alpha, there, there_alpha);
    return to_float(
        one_channel(Float64(color), Float64(alpha), Float64(there), Float64(there_alpha)));
}

// Programmable blending of codes, as render.emulate says. Colours are not associated.
LAMINA_INLINE void composite_codes(const TargetBlend& target, const Pixels& codes, Pixels& there) {
    const Float before = there.alpha, opaque(target.largest);
    there.red = composite_channel(target, codes.red, codes.alpha, there.red, before);
    there.green = composite_channel(target, codes.green, codes.alpha, there.green, before);
    there.blue = composite_channel(target, codes.blue, codes.alpha, there.blue, before);
    there.alpha = composite_channel(target, opaque, codes.alpha, before, before);
}

LAMINA_INLINE void composite_opacity(const TargetBlend& target, Float alpha, Float& there) {
    there = composite_channel(target, Float(target.largest), alpha, there, there);
}

// Returns the codes of opacities, rounded as render.emulate says. `random`: bits for stochastic
// rounding.
LAMINA_INLINE Float alpha_code(const TargetBlend& target, const Float64& opacity, Word random) {
    const double largest = target.largest;
    return to_float(
        round_alpha(target.alpha_rounding, split_scaled(largest * opacity), Float64(random)));
}

// Returns the codes of opacities or colours in 0..1, dithered along depth. `rank`: rank of the
// slab.
LAMINA_INLINE Float dithered_code(const TargetBlend& target, const Float64& value,
                                  const Dither& dither, std::uint32_t rank) {
    const double largest = target.largest;
    return to_float(dither_code(largest * value, rank, dither.period, dither.increment, largest));
}

LAMINA_INLINE Float color_code(const TargetBlend& target, Float color) {
    const double largest = target.largest;
    return to_float(code_nearest(largest * Float64(clamp01(color))));
}

// OVER in real arithmetic on stored codes. The result is rounded at random, with one random number
// for all channels (compositing/codes.h).
LAMINA_INLINE void composite_stochastic(const TargetBlend& target, const Fragment& fragment,
                                        Word random, Pixels& there) {
    const Float64 chance(random), alpha(fragment.alpha);
    const auto channel = [&](Float color, Float& pixel) LAMINA_LAMBDA {
        pixel = to_float(over_stochastic(Float64(clamp01(color)), alpha, Float64(pixel), chance,
                                         static_cast<double>(target.largest)));
    };
    channel(fragment.red, there.red);
    channel(fragment.green, there.green);
    channel(fragment.blue, there.blue);
    channel(fragment.alpha, there.alpha);
}

LAMINA_SIMD_END

#endif
