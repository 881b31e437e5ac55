// SPDX-License-Identifier: Apache-2.0
#include "projection/tile_fragments.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "projection/tile_fragments.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "projection/tet_color-inl.h"
#include "projection/tet_drawing-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Draws coloured parts in perspective over a float32 target.
struct PartShader {
    static constexpr bool lit = false, cut = true, scalars = true, perspective = true,
                          opacity_only = false;

    HWY_INLINE Fragment<Vector> color(Tag d, const TetFragments& fragments, const TetRecord& record,
                                      const PartArea& area, const TetRun<Vector>& run) const {
        return part_color(d, true, area.depth, fragments, record, run);
    }
    HWY_INLINE void put(Tag d, const TetFragments&, std::uint32_t, const Fragment<Vector>& fragment,
                        const TetTile& tile, std::size_t place) const {
        Pixels<Vector> there = load_pixels(d, *tile.pixels, place);
        blend(d, TargetBlend{}, fragment, there);
        store_pixels(d, there, *tile.pixels, place);
    }
};

std::int64_t draw_colored_parts(const TetFragments& fragments, const TileBatch& batch,
                                const TetTile& tile) {
    TetDrawing drawing(fragments, batch, tile);
    drawing.draw(PartShader());
    return drawing.fragments();
}

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lamina {

HWY_EXPORT(draw_colored_parts);

std::int64_t draw_tets(const TetFragments& fragments, const TileBatch& batch, const TetTile& tile) {
    if (batch.is_lit()) return draw_lit_tets(fragments, batch, tile);
    const bool known = fragments.source == SegmentSource::parts && fragments.colored &&
                       fragments.perspective && fragments.output == FragmentOutput::native &&
                       fragments.blend.target == Target::float32 && !fragments.opacity_only &&
                       !batch.has_triangles();
    if (!known) return draw_general_tets(fragments, batch, tile);
    return HWY_DYNAMIC_DISPATCH(draw_colored_parts)(fragments, batch, tile);
}

}  // namespace lamina
#endif
