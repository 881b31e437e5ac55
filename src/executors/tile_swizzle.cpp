// SPDX-License-Identifier: Apache-2.0
#include "executors/tile_fixed_tree.h"

#undef LAMINA_TARGET_FILE
#define LAMINA_TARGET_FILE "executors/tile_swizzle.cpp"
#include "simd/foreach_target.h"

#include "tiles/lane_pixels-inl.h"
#include "tiles/target_pixels-inl.h"

LAMINA_SIMD_BEGIN

// Maps the image of a node to its parent's (LaMar 2004, section 6.2, "swizzle"), as
// shaders/slicing/swizzle.frag does.
void swizzle_pixels(const TileSwizzle& swizzle, const TileGrid::Tile& area,
                    const TilePixels::Plane& child, TilePixels::Plane& node) {
    const TargetBlend& target = swizzle.blend;
    for (std::size_t place = 0; place < TileGrid::pixels; place += Float::lanes) {
        const TileGrid::Place at = TileGrid::pixel_at(static_cast<int>(place));
        if (at.column >= area.width || at.row >= area.height) continue;
        const Int code = to_int(load<Float>(child.data() + place));
        const Float whole = gather(swizzle.whole, code);
        const Float rest = gather(swizzle.rest, code);
        Float there = load<Float>(node.data() + place);
        if (!swizzle.emulated) {
            blend_opacity(target, (whole + rest) / target.largest, there);
            store(there, node.data() + place);
            continue;
        }
        Word random(0);
        if (target.alpha_rounding == AlphaRounding::stochastic) {
            random = random_of_pixels(area.column + at.column, area.row + at.row, swizzle.stage,
                                      target.seed);
        }
        const ScaledValues<Float64> scaled{Float64(whole), Float64(rest)};
        const Float64 code_of_alpha = round_alpha(target.alpha_rounding, scaled, Float64(random));
        composite_opacity(target, to_float(code_of_alpha), there);
        store(there, node.data() + place);
    }
}

// Makes the picture of one colour and the opacity in the root, as shaders/slicing/colorize.frag
// does.
void colorize_pixels(const TargetBlend& target, bool emulated,
                     const std::array<float, 3>& single_color, const TilePixels::Plane& root,
                     TilePixels& pixels) {
    pixels.alpha = root;
    TilePixels::Plane* const planes[3] = {&pixels.red, &pixels.green, &pixels.blue};
    const float unit = 1 / target.largest;  // as textures are read
    for (std::size_t channel = 0; channel < 3; ++channel) {
        const Float color(single_color[channel]);
        const Float code = color_code(target, color);
        for (std::size_t place = 0; place < TileGrid::pixels; place += Float::lanes) {
            const Float alpha = load<Float>(root.data() + place);
            // OVER onto nothing is the product, rounded.
            const Float associated =
                emulated ? composite_channel(target, code, alpha, Float(0), Float(0))
                         : native_code(target.largest, color * (alpha * unit));
            store(associated, planes[channel]->data() + place);
        }
    }
}

LAMINA_SIMD_END

#if LAMINA_ONCE
namespace lamina {

LAMINA_EXPORT(swizzle_pixels);
LAMINA_EXPORT(colorize_pixels);

void swizzle_tile(const TileSwizzle& swizzle, const TileGrid::Tile& area,
                  const TilePixels::Plane& child, TilePixels::Plane& node) {
    LAMINA_DISPATCH(swizzle_pixels)(swizzle, area, child, node);
}

void colorize_tile(const TargetBlend& blend, bool emulated,
                   const std::array<float, 3>& single_color, const TilePixels::Plane& root,
                   TilePixels& pixels) {
    LAMINA_DISPATCH(colorize_pixels)(blend, emulated, single_color, root, pixels);
}

}  // namespace lamina
#endif
