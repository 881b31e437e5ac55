// SPDX-License-Identifier: Apache-2.0
#include "projection/tile_fragments.h"

#undef LAMINA_TARGET_FILE
#define LAMINA_TARGET_FILE "projection/tile_lit_fragments.cpp"
#include "simd/foreach_target.h"

#include "projection/lit_shading-inl.h"

LAMINA_SIMD_BEGIN

std::int64_t draw_lit(const TetFragments& fragments, const TileBatch& batch, const TetTile& tile) {
    TetDrawing drawing(fragments, batch, tile);
    drawing.draw(LitShader(fragments));
    return drawing.fragments();
}

LAMINA_SIMD_END

#if LAMINA_ONCE
namespace lamina {

LAMINA_EXPORT(draw_lit);

std::int64_t draw_lit_tets(const TetFragments& fragments, const TileBatch& batch,
                           const TetTile& tile) {
    return LAMINA_DISPATCH(draw_lit)(fragments, batch, tile);
}

}  // namespace lamina
#endif
