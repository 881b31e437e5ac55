// SPDX-License-Identifier: Apache-2.0
// How a target composites fragments. Functions take and return vectors of a tile's planes
// (tiles/tile_image.h). `d` is the descriptor of floats.
#if defined(LAMINA_TILES_TARGET_PIXELS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_TILES_TARGET_PIXELS_INL_H_
#undef LAMINA_TILES_TARGET_PIXELS_INL_H_
#else
#define LAMINA_TILES_TARGET_PIXELS_INL_H_
#endif

#include <hwy/highway.h>

#include "tiles/arithmetic-inl.h"
#include "tiles/codes-inl.h"
#include "tiles/dither-inl.h"
#include "tiles/doubles-inl.h"
#include "tiles/over-inl.h"
#include "tiles/stochastic_over-inl.h"
#include "tiles/target_blend.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class V>
struct Pixels {
    V red, green, blue, alpha;
};

// The associated colour and the opacity of a vector of fragments or pixels.
template <class V>
struct Fragment {
    V red, green, blue, alpha;
};

// Rounds towards zero to half precision, as llvmpipe stores floats. Below 2^-14 the last place is
// 2^-24.
template <class D>
HWY_INLINE hn::Vec<D> truncate_to_half(D d, hn::Vec<D> v) {
    const hn::RebindToUnsigned<D> du;
    const auto normal = hn::BitCast(d, hn::And(hn::BitCast(du, v), hn::Set(du, ~0x1fffu)));
    const auto small = hn::Mul(hn::Trunc(hn::Mul(v, hn::Set(d, 0x1p24f))), hn::Set(d, 0x1p-24f));
    const auto half = hn::IfThenElse(hn::Lt(hn::Abs(v), hn::Set(d, 0x1p-14f)), small, normal);
    return hn::Min(half, hn::Set(d, 65504.0f));
}

// The product of two codes of `bits` bits as the blending unit of llvmpipe rounds it.
template <class D>
HWY_INLINE hn::Vec<D> multiply_codes(D d, int bits, hn::Vec<D> a, hn::Vec<D> b) {
    if (bits == 8) {
        const auto product = hn::Mul(a, b), step = hn::Set(d, 1.0f / 256);
        const auto sum = hn::Add(product, hn::Floor(hn::Mul(product, step)));
        return hn::Floor(hn::Mul(hn::Add(sum, hn::Set(d, 128.0f)), step));
    }
    const hn::RebindToSigned<D> di;
    const hn::RebindToUnsigned<D> du;
    const auto whole = [du, di](hn::Vec<D> v) { return hn::BitCast(du, hn::ConvertTo(di, v)); };
    const auto product = hn::Mul(whole(a), whole(b));
    const auto sum = hn::Add(product, hn::ShiftRight<16>(product));
    const auto code = hn::ShiftRight<16>(hn::Add(sum, hn::Set(du, 0x8000u)));
    return hn::ConvertTo(d, hn::BitCast(di, code));
}

// The code nearest to a colour or opacity.
template <class D>
HWY_INLINE hn::Vec<D> native_code(D d, float largest, hn::Vec<D> value) {
    return hn::Round(hn::Mul(clamp01(d, value), hn::Set(d, largest)));
}

// One channel of blend(). `kept`: the share of the pixel that the source leaves visible or, front
// to back, the share of the source that the pixel leaves visible.
template <class D>
HWY_INLINE void blend_channel(D d, const TargetBlend& target, hn::Vec<D> source, hn::Vec<D> kept,
                              hn::Vec<D>& there) {
    const bool behind = target.order == Order::front_to_back;
    if (is_fixed_point(target.target)) {
        const auto product = multiply_codes(d, target.bits, behind ? source : there, kept);
        const auto sum = hn::Add(product, behind ? there : source);
        there = hn::Min(sum, hn::Set(d, target.largest));
        return;
    }
    const auto sum = behind ? mul_add(source, kept, there) : mul_add(there, kept, source);
    there = target.target == Target::float16 ? truncate_to_half(d, sum) : sum;
}

// Computes what the blending unit of a float32, float16, fixed8 or fixed16 target computes: source
// + there (1 - source alpha), or front to back there + source (1 - there alpha). Fixed-point
// targets round the fragment to codes first, and then the product. All rounding is that of
// llvmpipe.
template <class D>
HWY_INLINE void blend(D d, const TargetBlend& target, const Fragment<hn::Vec<D>>& fragment,
                      Pixels<hn::Vec<D>>& there) {
    Fragment<hn::Vec<D>> source = fragment;
    if (is_fixed_point(target.target)) {
        source.red = native_code(d, target.largest, source.red);
        source.green = native_code(d, target.largest, source.green);
        source.blue = native_code(d, target.largest, source.blue);
        source.alpha = native_code(d, target.largest, source.alpha);
    }
    const auto kept = hn::Sub(hn::Set(d, target.largest),
                              target.order == Order::front_to_back ? there.alpha : source.alpha);
    blend_channel(d, target, source.red, kept, there.red);
    blend_channel(d, target, source.green, kept, there.green);
    blend_channel(d, target, source.blue, kept, there.blue);
    blend_channel(d, target, source.alpha, kept, there.alpha);
}

// The same for opacity alone.
template <class D>
HWY_INLINE void blend_opacity(D d, const TargetBlend& target, hn::Vec<D> opacity,
                              hn::Vec<D>& there) {
    const auto source =
        is_fixed_point(target.target) ? native_code(d, target.largest, opacity) : opacity;
    const auto kept =
        hn::Sub(hn::Set(d, target.largest), target.order == Order::front_to_back ? there : source);
    blend_channel(d, target, source, kept, there);
}

// OVER or UNDER of one channel, in floats where they are precise enough.
template <class D>
HWY_INLINE hn::Vec<D> composite_channel(D d, const TargetBlend& target, hn::Vec<D> color,
                                        hn::Vec<D> alpha, hn::Vec<D> there,
                                        hn::Vec<D> there_alpha) {
    const bool behind = target.order == Order::front_to_back;
    const int float_bits = behind && target.over_rounding == OverRounding::fused
                               ? max_float_under_bits
                               : max_float_over_bits;
    const auto one_channel = [&](auto tag, auto c, auto a, auto t, auto ta) HWY_ATTR {
        const auto largest = static_cast<hn::TFromD<decltype(tag)>>(target.largest);
        return behind ? under(tag, target.over_rounding, c, a, t, ta, largest)
                      : over(tag, target.over_rounding, c, a, t, largest);
    };
    if (target.bits <= float_bits) return one_channel(d, color, alpha, there, there_alpha);
    const typename Doubles<D>::Tag dd;
    const Doubles<D> c = to_doubles(d, color), a = to_doubles(d, alpha);
    const Doubles<D> t = to_doubles(d, there), ta = to_doubles(d, there_alpha);
    return to_floats(d, Doubles<D>{one_channel(dd, c.low, a.low, t.low, ta.low),
                                   one_channel(dd, c.high, a.high, t.high, ta.high)});
}

// Programmable blending of codes, as render.emulate says. Colours are not associated.
template <class D>
HWY_INLINE void composite_codes(D d, const TargetBlend& target, const Pixels<hn::Vec<D>>& codes,
                                Pixels<hn::Vec<D>>& there) {
    const auto before = there.alpha, opaque = hn::Set(d, target.largest);
    there.red = composite_channel(d, target, codes.red, codes.alpha, there.red, before);
    there.green = composite_channel(d, target, codes.green, codes.alpha, there.green, before);
    there.blue = composite_channel(d, target, codes.blue, codes.alpha, there.blue, before);
    there.alpha = composite_channel(d, target, opaque, codes.alpha, before, before);
}

template <class D>
HWY_INLINE void composite_opacity(D d, const TargetBlend& target, hn::Vec<D> alpha,
                                  hn::Vec<D>& there) {
    const auto opaque = hn::Set(d, target.largest);
    there = composite_channel(d, target, opaque, alpha, there, there);
}

// The codes of opacities, rounded as render.emulate says. `random`: bits for stochastic rounding.
template <class D>
HWY_INLINE hn::Vec<D> alpha_code(D d, const TargetBlend& target, const Doubles<D>& opacity,
                                 hn::Vec<hn::RebindToUnsigned<D>> random) {
    const typename Doubles<D>::Tag dd;
    const auto largest = hn::Set(dd, static_cast<double>(target.largest));
    const auto round = [&](auto value, auto bits) HWY_ATTR {
        return round_alpha(dd, target.alpha_rounding, split_scaled(dd, hn::Mul(largest, value)),
                           bits);
    };
    return to_floats(d, each_half(round, opacity, to_doubles_of_bits(d, random)));
}

// The codes of opacities or colours in 0..1, dithered along depth. `rank`: rank of the slab.
template <class D>
HWY_INLINE hn::Vec<D> dithered_code(D d, const TargetBlend& target, const Doubles<D>& value,
                                    const Dither& dither, std::uint32_t rank) {
    const typename Doubles<D>::Tag dd;
    const double largest = target.largest;
    const auto code = [&](auto v) HWY_ATTR {
        return dither_code(dd, hn::Mul(hn::Set(dd, largest), v), rank, dither.period,
                           dither.increment, largest);
    };
    return to_floats(d, each_half(code, value));
}

// The nearest codes of colours.
template <class D>
HWY_INLINE hn::Vec<D> color_code(D d, const TargetBlend& target, hn::Vec<D> color) {
    const typename Doubles<D>::Tag dd;
    const auto largest = hn::Set(dd, static_cast<double>(target.largest));
    const auto code = [&](auto v) HWY_ATTR { return code_nearest(dd, hn::Mul(largest, v)); };
    return to_floats(d, each_half(code, to_doubles(d, clamp01(d, color))));
}

// OVER in real arithmetic on stored codes. The result is rounded at random, with one random number
// for all channels (compositing/stochastic_over.h).
template <class D>
HWY_INLINE void composite_stochastic(D d, const TargetBlend& target,
                                     const Fragment<hn::Vec<D>>& fragment,
                                     hn::Vec<hn::RebindToUnsigned<D>> random,
                                     Pixels<hn::Vec<D>>& there) {
    const typename Doubles<D>::Tag dd;
    const Doubles<D> chance = to_doubles_of_bits(d, random), alpha = to_doubles(d, fragment.alpha);
    const auto channel = [&](hn::Vec<D> color, hn::Vec<D>& pixel) HWY_ATTR {
        const Doubles<D> source = to_doubles(d, clamp01(d, color)), below = to_doubles(d, pixel);
        const double largest = target.largest;
        pixel = to_floats(
            d, Doubles<D>{
                   over_stochastic(dd, source.low, alpha.low, below.low, chance.low, largest),
                   over_stochastic(dd, source.high, alpha.high, below.high, chance.high, largest)});
    };
    channel(fragment.red, there.red);
    channel(fragment.green, there.green);
    channel(fragment.blue, there.blue);
    channel(fragment.alpha, there.alpha);
}

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
