// SPDX-License-Identifier: Apache-2.0
#include "projection/tile_fragments.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "projection/tile_lit_fragments.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "projection/lit_shading-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {

std::int64_t draw_lit(const TetFragments& fragments, const TileBatch& batch, const TetTile& tile) {
    TetDrawing drawing(fragments, batch, tile);
    drawing.draw(LitShader(fragments));
    return drawing.fragments();
}

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lamina {

HWY_EXPORT(draw_lit);

std::int64_t draw_lit_tets(const TetFragments& fragments, const TileBatch& batch,
                           const TetTile& tile) {
    return HWY_DYNAMIC_DISPATCH(draw_lit)(fragments, batch, tile);
}

}  // namespace lamina
#endif
