// SPDX-License-Identifier: Apache-2.0
#include "slicing/slice_renderer.h"

#include "slicing/gl_slice_renderer.h"
#include "slicing/tile_slice_renderer.h"

namespace lamina {

std::unique_ptr<FrameRenderer> make_slice_renderer(const Volume& volume,
                                                   const TransferFunction& transfer_function,
                                                   const Facts& facts, const SlicePlan& plan,
                                                   const Capabilities& capabilities, int width,
                                                   int height, const FrameRenderer* before) {
    if (capabilities.tiles) {
        const auto* const tiles = dynamic_cast<const TileSliceRenderer*>(before);
        return std::make_unique<TileSliceRenderer>(volume, transfer_function, facts, plan, width,
                                                   height, tiles ? tiles->volume() : nullptr);
    }
    const auto* const textures = dynamic_cast<const GlSliceRenderer*>(before);
    return std::make_unique<GlSliceRenderer>(volume, transfer_function, facts, plan, capabilities,
                                             width, height,
                                             textures ? textures->volume() : nullptr);
}

}  // namespace lamina
