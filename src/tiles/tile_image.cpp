// SPDX-License-Identifier: Apache-2.0
#include "tiles/tile_image.h"

#include "base/parallel.h"

namespace lamina {

// Writes all tiles once, in parallel: the system is slow to provide memory, on its first write.
TileImage::TileImage(int width, int height)
    : grid_(width, height),
      tiles_(
          std::make_unique_for_overwrite<TilePixels[]>(static_cast<std::size_t>(grid_.count()))) {
    parallel_for(grid_.count(), 1, [&](std::int64_t i) { tile(static_cast<int>(i)) = {}; });
}

void TileImage::read(float largest_code, Image& image) const {
    image.resize(grid_.width(), grid_.height());
    parallel_for(grid_.count(), 8, [&](std::int64_t i) {
        const auto number = static_cast<int>(i);
        const TileGrid::Tile area = grid_.tile(number);
        const TilePixels& pixels = tile(number);
        for (int row = 0; row < area.height; ++row) {
            for (int column = 0; column < area.width; ++column) {
                const auto place = static_cast<std::size_t>(TileGrid::place(column, row));
                float* const rgba = image.pixel(area.column + column, area.row + row);
                rgba[0] = pixels.red[place] / largest_code;
                rgba[1] = pixels.green[place] / largest_code;
                rgba[2] = pixels.blue[place] / largest_code;
                rgba[3] = pixels.alpha[place] / largest_code;
            }
        }
    });
}

TargetBlend target_blend(const CompositingPlan& plan) {
    TargetBlend blend;
    blend.target = plan.target;
    blend.bits = plan.code_bits();
    if (is_fixed_point(plan.target)) blend.largest = static_cast<float>(largest_code(blend.bits));
    blend.order = plan.order;
    if (plan.emulation) {
        blend.alpha_rounding = plan.emulation->alpha;
        blend.over_rounding = plan.emulation->over;
        blend.seed = plan.emulation->seed;
    }
    return blend;
}

}  // namespace lamina
