// SPDX-License-Identifier: Apache-2.0
// How fragments are written to their pixels: vector form of shaders/projection/output.glsl.
// Fragments with neither opacity nor colour leave their pixels unchanged in all targets.
#if defined(LAMINA_PROJECTION_FRAGMENT_OUTPUT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_PROJECTION_FRAGMENT_OUTPUT_INL_H_
#undef LAMINA_PROJECTION_FRAGMENT_OUTPUT_INL_H_
#else
#define LAMINA_PROJECTION_FRAGMENT_OUTPUT_INL_H_
#endif

#include <hwy/highway.h>

#include "base/unreachable.h"
#include "projection/tile_fragments.h"
#include "tiles/lane_pixels-inl.h"
#include "tiles/target_pixels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

inline bool is_random(FragmentOutput output, const TargetBlend& target) {
    return output == FragmentOutput::dithered || output == FragmentOutput::stochastic ||
           (output == FragmentOutput::emulated &&
            target.alpha_rounding == AlphaRounding::stochastic);
}

// For the pixels of a tile from `place` on, and the cell fragment that is drawn.
template <class D>
HWY_INLINE hn::Vec<hn::RebindToUnsigned<D>> random_of_fragments(D, const TetFragments& fragments,
                                                                const TileGrid::Tile& area,
                                                                std::size_t place,
                                                                std::uint32_t number) {
    const hn::RebindToUnsigned<D> du;
    const TileGrid::Place first = TileGrid::pixel_at(static_cast<int>(place));
    return random_of_pixels(du, area.column + first.column, area.row + first.row, number,
                            fragments.seed);
}

// Dithers as in Kraus 2004, section 4.2, but with one random number for all channels, because the
// blending unit rounds associated colours, too.
template <class D>
HWY_INLINE hn::Vec<D> dithered(D d, float largest, hn::Vec<D> value, hn::Vec<D> random) {
    const auto scaled = hn::Mul(clamp01(d, value), hn::Set(d, largest));
    const auto whole = hn::Floor(scaled);
    const auto up = hn::Lt(random, hn::Sub(scaled, whole));
    return hn::Div(hn::Add(whole, hn::IfThenElseZero(up, hn::Set(d, 1.0f))), hn::Set(d, largest));
}

// 24 of the random bits as a number in [0, 1).
template <class D>
HWY_INLINE hn::Vec<D> as_share(D d, hn::Vec<hn::RebindToUnsigned<D>> random) {
    const hn::RebindToSigned<D> di;
    return hn::Mul(hn::ConvertTo(d, hn::BitCast(di, hn::ShiftRight<8>(random))),
                   hn::Set(d, 0x1p-24f));
}

template <class D>
HWY_INLINE void put_codes(D d, const TargetBlend& target, const Fragment<hn::Vec<D>>& fragment,
                          hn::Vec<hn::RebindToUnsigned<D>> random, Pixels<hn::Vec<D>>& there) {
    const auto seen = hn::Gt(fragment.alpha, hn::Zero(d));
    const auto code = [&](hn::Vec<D> color) HWY_ATTR {
        return color_code(d, target, hn::IfThenElseZero(seen, hn::Div(color, fragment.alpha)));
    };
    const auto alpha = alpha_code(d, target, to_doubles(d, fragment.alpha), random);
    composite_codes(
        d, target,
        Pixels<hn::Vec<D>>{code(fragment.red), code(fragment.green), code(fragment.blue), alpha},
        there);
}

template <class D>
HWY_INLINE void put_fragment(D d, const TetFragments& fragments,
                             const Fragment<hn::Vec<D>>& fragment,
                             hn::Vec<hn::RebindToUnsigned<D>> random, Pixels<hn::Vec<D>>& there) {
    const TargetBlend& target = fragments.blend;
    switch (fragments.output) {
        case FragmentOutput::emulated:
            put_codes(d, target, fragment, random, there);
            break;
        case FragmentOutput::stochastic:
            composite_stochastic(d, target, fragment, random, there);
            break;
        case FragmentOutput::dithered: {
            const auto share = as_share(d, random);
            const auto code = [&](hn::Vec<D> v)
                                  HWY_ATTR { return dithered(d, target.largest, v, share); };
            blend(d, target,
                  Fragment<hn::Vec<D>>{code(fragment.red), code(fragment.green),
                                       code(fragment.blue), code(fragment.alpha)},
                  there);
            break;
        }
        case FragmentOutput::native:
            blend(d, target, fragment, there);
            break;
    }
}

// Puts opacity alone over `there`.
template <class D>
HWY_INLINE hn::Vec<D> put_opacity(D d, const TetFragments& fragments, hn::Vec<D> opacity,
                                  hn::Vec<hn::RebindToUnsigned<D>> random, hn::Vec<D> there) {
    const TargetBlend& target = fragments.blend;
    switch (fragments.output) {
        case FragmentOutput::emulated:
            composite_opacity(d, target, alpha_code(d, target, to_doubles(d, opacity), random),
                              there);
            return there;
        case FragmentOutput::stochastic: {
            Pixels<hn::Vec<D>> pixels{there, there, there, there};
            composite_stochastic(d, target,
                                 Fragment<hn::Vec<D>>{opacity, opacity, opacity, opacity}, random,
                                 pixels);
            return pixels.alpha;
        }
        case FragmentOutput::dithered:
            blend_opacity(d, target, dithered(d, target.largest, opacity, as_share(d, random)),
                          there);
            return there;
        case FragmentOutput::native:
            blend_opacity(d, target, opacity, there);
            return there;
    }
    unreachable_enum();
}

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
