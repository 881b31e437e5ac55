// SPDX-License-Identifier: Apache-2.0
#include "executors/tile_fixed_tree.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "executors/tile_swizzle.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "tiles/lane_pixels-inl.h"
#include "tiles/target_pixels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {

using Tag = hn::CappedTag<float, TileGrid::block * TileGrid::block>;
using Wide = hn::Repartition<double, Tag>;

// Maps the image of a node to its parent's (LaMar 2004, section 6.2, "swizzle"), as
// shaders/slicing/swizzle.frag does.
void swizzle_pixels(const TileSwizzle& swizzle, const TileGrid::Tile& area,
                    const TilePixels::Plane& child, TilePixels::Plane& node) {
    const Tag d;
    const Wide dd;
    const hn::RebindToSigned<Tag> di;
    const hn::RebindToUnsigned<Tag> du;
    const TargetBlend& target = swizzle.blend;
    for (std::size_t place = 0; place < TileGrid::pixels; place += hn::Lanes(d)) {
        const TileGrid::Place at = TileGrid::pixel_at(static_cast<int>(place));
        if (at.column >= area.width || at.row >= area.height) continue;
        const auto code = hn::ConvertTo(di, hn::Load(d, child.data() + place));
        const auto whole = hn::GatherIndex(d, swizzle.whole, code);
        const auto rest = hn::GatherIndex(d, swizzle.rest, code);
        auto there = hn::Load(d, node.data() + place);
        if (!swizzle.emulated) {
            const auto opacity = hn::Div(hn::Add(whole, rest), hn::Set(d, target.largest));
            blend_opacity(d, target, opacity, there);
            hn::Store(there, d, node.data() + place);
            continue;
        }
        auto random = hn::Zero(du);
        if (target.alpha_rounding == AlphaRounding::stochastic) {
            random = random_of_pixels(du, area.column + at.column, area.row + at.row, swizzle.stage,
                                      target.seed);
        }
        const auto wholes = to_doubles(d, whole), rests = to_doubles(d, rest);
        const auto chance = to_doubles_of_bits(d, random);
        const auto round = [&](auto w, auto r, auto bits) HWY_ATTR {
            return round_alpha(dd, target.alpha_rounding, ScaledValues<decltype(w)>{w, r}, bits);
        };
        composite_opacity(d, target, to_floats(d, each_half(round, wholes, rests, chance)), there);
        hn::Store(there, d, node.data() + place);
    }
}

// Makes the picture of one colour and the opacity in the root, as shaders/slicing/colorize.frag
// does.
void colorize_pixels(const TargetBlend& target, bool emulated,
                     const std::array<float, 3>& single_color, const TilePixels::Plane& root,
                     TilePixels& pixels) {
    const Tag d;
    pixels.alpha = root;
    TilePixels::Plane* const planes[3] = {&pixels.red, &pixels.green, &pixels.blue};
    const auto unit = hn::Set(d, 1 / target.largest);  // as textures are read
    for (std::size_t channel = 0; channel < 3; ++channel) {
        const auto color = hn::Set(d, single_color[channel]);
        const auto code = color_code(d, target, color);
        for (std::size_t place = 0; place < TileGrid::pixels; place += hn::Lanes(d)) {
            const auto alpha = hn::Load(d, root.data() + place);
            // OVER of nothing is the product, rounded.
            const auto associated =
                emulated ? composite_channel(d, target, code, alpha, hn::Zero(d), hn::Zero(d))
                         : native_code(d, target.largest, hn::Mul(color, hn::Mul(alpha, unit)));
            hn::Store(associated, d, planes[channel]->data() + place);
        }
    }
}

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lamina {

HWY_EXPORT(swizzle_pixels);
HWY_EXPORT(colorize_pixels);

void swizzle_tile(const TileSwizzle& swizzle, const TileGrid::Tile& area,
                  const TilePixels::Plane& child, TilePixels::Plane& node) {
    HWY_DYNAMIC_DISPATCH(swizzle_pixels)(swizzle, area, child, node);
}

void colorize_tile(const TargetBlend& blend, bool emulated,
                   const std::array<float, 3>& single_color, const TilePixels::Plane& root,
                   TilePixels& pixels) {
    HWY_DYNAMIC_DISPATCH(colorize_pixels)(blend, emulated, single_color, root, pixels);
}

}  // namespace lamina
#endif
