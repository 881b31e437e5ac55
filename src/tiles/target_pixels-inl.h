// SPDX-License-Identifier: Apache-2.0
// Composites fragments onto a vector of pixels of a tile (tiles/tile_image.h). The first half, up
// to random_of_pixels(), holds vector forms of compositing/codes.h, bit for bit. In the second,
// blend() composites as OpenGL's blending unit does, with llvmpipe's rounding; composite_codes()
// computes OVER on codes, rounded as render.emulate says; composite_stochastic() rounds at random.
// blend_opacity() and composite_opacity() composite one channel.
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

// Bits of a code up to which OVER and UNDER may compute in floats. With M the largest code, over()
// and separate under() divide whole numbers of at most M^2 + M / 2 by M. A float has 24 bits and
// holds these exactly if M < 2^12. The quotient is below 2^12, so the float division rounds it by
// less than 2^-12, and cannot reach the next whole number, which is at least 1 / M away. Fused
// under() divides at most M^3 + M^2 / 2 by M^2, so quotients are at least 1 / M^2 from the next
// whole number: M < 2^8. With more bits doubles are used: they hold the 48 bits of M^3 + M^2 / 2
// for M < 2^16, and round quotients by less than 2^-37.
inline constexpr int max_float_over_bits = 12;
inline constexpr int max_float_under_bits = 8;

// Rounds x / n to the nearest whole number; n is odd.
template <class V>
LAMINA_INLINE V divide_nearest(V x, typename V::Scalar n) {
    return floor((x + (n - 1) / 2) / n);
}

// Returns `color` with opacity `alpha` over `below`, all codes 0 .. largest.
template <class V>
LAMINA_INLINE V over(OverRounding rounding, V color, V alpha, V below, typename V::Scalar largest) {
    const V source = color * alpha;
    const V kept = below * (largest - alpha);
    return rounding == OverRounding::fused
               ? divide_nearest(source + kept, largest)
               : divide_nearest(source, largest) + divide_nearest(kept, largest);
}

// Returns `above`, an associated colour of opacity `above_alpha`, with `color` of opacity `alpha`
// added behind it; all are codes 0 .. largest.
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

// Rounds opacity times the largest code to a code. `random`: 32 bits, for stochastic rounding.
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

// Returns the code of a scaled value, dithered along depth: of `period` slabs, the floor(period *
// rest) with the lowest ranks get the code above the value, the others the code below.
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

// Returns random bits for a vector of pixels: 4 x 1, 4 x 2 or 4 x 4 of them, depending on the
// length of vectors. The first pixel is (column, row) of the picture, rows from the top.
LAMINA_INLINE Word random_of_pixels(int column, int row, std::uint32_t sample, std::uint32_t seed) {
    const Word lanes = iota<Word>(0);
    return random_bits(static_cast<std::uint32_t>(column) + (lanes & 3u),
                       static_cast<std::uint32_t>(row) + shift_right<2>(lanes), Word(sample),
                       Word(seed));
}

// Colour and opacity of a vector of pixels, or of fragments: 0 .. 1, or codes if the target has
// codes. Colours are associated, except in the `codes` that composite_codes() gets.
struct Pixels {
    Float red, green, blue, alpha;
};
using Fragment = Pixels;

// Rounds towards 0 to half precision, as llvmpipe does; below 2^-14 halves are multiples of 2^-24.
LAMINA_INLINE Float truncate_to_half(Float v) {
    const Float normal = bits_as<Float>(bits_as<Word>(v) & ~0x1fffu);
    const Float small = trunc(v * 0x1p24f) * 0x1p-24f;
    const Float half = select(abs(v) < 0x1p-14f, small, normal);
    return min(half, 65504.0f);
}

// Returns the product of two codes of `bits` bits (8 or 16) as llvmpipe's blending unit rounds it.
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

// Returns the code to which OpenGL converts a value for a fixed-point target.
LAMINA_INLINE Float native_code(float largest, Float value) {
    return round(clamp01(value) * largest);
}

// Blends `source` onto one channel. `kept`: target.largest times the transmittance of the source
// or, front to back, of the pixel.
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

// Composites as the blending unit does: source + there (1 - source alpha) or, if the order is front
// to back, there + source (1 - there alpha). Fixed-point targets round the fragment to codes first,
// and then the product. All rounding is llvmpipe's.
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

// Returns OVER or, front to back, UNDER of one channel, in floats if they are precise enough.
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

// Composites codes as programmable blending with render.emulate does. Colours in `codes` are not
// associated; those in `there` are.
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

// Returns the codes of opacities, rounded as render.emulate says. `random`: see round_alpha().
LAMINA_INLINE Float alpha_code(const TargetBlend& target, const Float64& opacity, Word random) {
    const double largest = target.largest;
    return to_float(
        round_alpha(target.alpha_rounding, split_scaled(largest * opacity), Float64(random)));
}

// Returns the codes of opacities or colours in 0..1, dithered along depth by the slab's `rank`.
LAMINA_INLINE Float dithered_code(const TargetBlend& target, const Float64& value,
                                  const Dither& dither, std::uint32_t rank) {
    const double largest = target.largest;
    return to_float(dither_code(largest * value, rank, dither.period, dither.increment, largest));
}

LAMINA_INLINE Float color_code(const TargetBlend& target, Float color) {
    const double largest = target.largest;
    return to_float(code_nearest(largest * Float64(clamp01(color))));
}

// Composites a fragment by OVER in real arithmetic on stored codes. The result is rounded at
// random, with one random number for all channels (compositing/codes.h).
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
