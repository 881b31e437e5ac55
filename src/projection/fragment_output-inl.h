// SPDX-License-Identifier: Apache-2.0
// The output of fragments to their pixels: vector form of shaders/projection/output.glsl. Fragments
// with neither opacity nor colour leave their pixels unchanged in all targets.
#if defined(LAMINA_PROJECTION_FRAGMENT_OUTPUT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_PROJECTION_FRAGMENT_OUTPUT_INL_H_
#undef LAMINA_PROJECTION_FRAGMENT_OUTPUT_INL_H_
#else
#define LAMINA_PROJECTION_FRAGMENT_OUTPUT_INL_H_
#endif

#include "base/enum_words.h"
#include "projection/tile_fragments.h"
#include "tiles/target_pixels-inl.h"

LAMINA_SIMD_BEGIN

inline bool is_random(FragmentOutput output, const TargetBlend& target) {
    return output == FragmentOutput::dithered || output == FragmentOutput::stochastic ||
           (output == FragmentOutput::emulated &&
            target.alpha_rounding == AlphaRounding::stochastic);
}

// Returns random bits for the pixels of a tile from `place` on, and the cell fragment that is
// drawn.
LAMINA_INLINE Word random_of_fragments(const TetFragments& fragments, const TileGrid::Tile& area,
                                       std::size_t place, std::uint32_t number) {
    const TileGrid::Place first = TileGrid::pixel_at(static_cast<int>(place));
    return random_of_pixels(area.column + first.column, area.row + first.row, number,
                            fragments.seed);
}

// Dithers as in Kraus 2004, section 4.2, but with one random number for all channels, because the
// blending unit rounds associated colours, too.
LAMINA_INLINE Float dithered(float largest, Float value, Float random) {
    const Float scaled = clamp01(value) * largest;
    const Float whole = floor(scaled);
    const FloatMask up = random < scaled - whole;
    return (whole + zero_unless(up, Float(1))) / largest;
}

// Returns 24 of the random bits as a number in [0, 1).
LAMINA_INLINE Float as_share(Word random) {
    return to_float(bits_as<Int>(shift_right<8>(random))) * 0x1p-24f;
}

LAMINA_INLINE void put_codes(const TargetBlend& target, const Fragment& fragment, Word random,
                             Pixels& there) {
    const FloatMask seen = fragment.alpha > 0;
    const auto code = [&](Float color) LAMINA_LAMBDA {
        return color_code(target, zero_unless(seen, color / fragment.alpha));
    };
    const Float alpha = alpha_code(target, Float64(fragment.alpha), random);
    composite_codes(target,
                    Pixels{code(fragment.red), code(fragment.green), code(fragment.blue), alpha},
                    there);
}

LAMINA_INLINE void put_fragment(const TetFragments& fragments, const Fragment& fragment,
                                Word random, Pixels& there) {
    const TargetBlend& target = fragments.blend;
    switch (fragments.output) {
        case FragmentOutput::emulated:
            put_codes(target, fragment, random, there);
            break;
        case FragmentOutput::stochastic:
            composite_stochastic(target, fragment, random, there);
            break;
        case FragmentOutput::dithered: {
            const Float share = as_share(random);
            const auto code = [&](Float v)
                                  LAMINA_LAMBDA { return dithered(target.largest, v, share); };
            blend(target,
                  Fragment{code(fragment.red), code(fragment.green), code(fragment.blue),
                           code(fragment.alpha)},
                  there);
            break;
        }
        case FragmentOutput::native:
            blend(target, fragment, there);
            break;
    }
}

// Puts opacity alone over `there`.
LAMINA_INLINE Float put_opacity(const TetFragments& fragments, Float opacity, Word random,
                                Float there) {
    const TargetBlend& target = fragments.blend;
    switch (fragments.output) {
        case FragmentOutput::emulated:
            composite_opacity(target, alpha_code(target, Float64(opacity), random), there);
            return there;
        case FragmentOutput::stochastic: {
            Pixels pixels{there, there, there, there};
            composite_stochastic(target, Fragment{opacity, opacity, opacity, opacity}, random,
                                 pixels);
            return pixels.alpha;
        }
        case FragmentOutput::dithered:
            blend_opacity(target, dithered(target.largest, opacity, as_share(random)), there);
            return there;
        case FragmentOutput::native:
            blend_opacity(target, opacity, there);
            return there;
    }
    unreachable_enum();
}

LAMINA_SIMD_END

#endif
