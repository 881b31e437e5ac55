// SPDX-License-Identifier: Apache-2.0
#include "projection/cpu_fragments.h"

#undef LAMINA_TARGET_FILE
#define LAMINA_TARGET_FILE "projection/cpu_fragments.cpp"
#include "simd/foreach_target.h"

#include "projection/tet_drawing-inl.h"

LAMINA_SIMD_BEGIN

// A Shader (tet_drawing-inl.h) for the most frequent plans: coloured cell fragments in perspective,
// over a float32 target.
struct CellFragmentShader {
    static constexpr bool lit = false, cut = true, scalars = true, perspective = true,
                          opacity_only = false;

    LAMINA_INLINE Fragment color(const TetFragments& fragments, const SilhouetteRecord& record,
                                 const CoveredArea& area, const FragmentSegment& segment) const {
        return cell_fragment_color(true, area.depth, fragments, record.fragment, segment);
    }
    LAMINA_INLINE void put(const TetFragments&, std::uint32_t, const Fragment& fragment,
                           const TetTile& tile, std::size_t place) const {
        Pixels there = load_pixels(*tile.pixels, place);
        blend(TargetBlend{}, fragment, there);
        store_pixels(there, *tile.pixels, place);
    }
};

// Implements draw_tets() for these plans.
std::int64_t draw_colored_cell_fragments(const TetFragments& fragments, const TileBatch& batch,
                                         const TetTile& tile) {
    TetDrawing drawing(fragments, batch, tile);
    drawing.draw(CellFragmentShader());
    return drawing.fragments();
}

LAMINA_SIMD_END

#if LAMINA_ONCE
namespace lamina {

LAMINA_EXPORT(draw_colored_cell_fragments);

std::int64_t draw_tets(const TetFragments& fragments, const TileBatch& batch, const TetTile& tile) {
    if (batch.is_lit()) return draw_lit_tets(fragments, batch, tile);
    const bool known = fragments.source == SegmentSource::parts && fragments.colored &&
                       fragments.perspective && fragments.output == FragmentOutput::native &&
                       fragments.blend.target == Target::float32 && !fragments.opacity_only &&
                       !batch.has_triangles();
    if (!known) return draw_general_tets(fragments, batch, tile);
    return LAMINA_DISPATCH(draw_colored_cell_fragments)(fragments, batch, tile);
}

}  // namespace lamina
#endif
