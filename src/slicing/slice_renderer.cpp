// SPDX-License-Identifier: Apache-2.0
#include "slicing/slice_renderer.h"

#include "slicing/gl_slice_renderer.h"
#include "slicing/tile_slice_renderer.h"

namespace lamina {

std::unique_ptr<SliceRenderer> make_slice_renderer(const Volume& volume,
                                                   const TransferFunction& transfer_function,
                                                   const Facts& facts, const SlicePlan& plan,
                                                   const Capabilities& capabilities, int width,
                                                   int height, const SliceParts& ready) {
    if (capabilities.tiles) {
        return std::make_unique<TileSliceRenderer>(volume, transfer_function, facts, plan, width,
                                                   height, ready.tiles);
    }
    return std::make_unique<GlSliceRenderer>(volume, transfer_function, facts, plan, capabilities,
                                             width, height, ready.textures);
}

}  // namespace lamina
