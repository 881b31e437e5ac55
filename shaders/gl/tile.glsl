// SPDX-License-Identifier: Apache-2.0
// A workgroup draws a tile of pixels in Morton order: llvmpipe fills its lanes with consecutive invocations,
// and GPUs their warps, so that lanes and warps hold neighbours of the picture, whose rays take about the same
// way. GROUP: pixels of a tile, 32 (8 x 4), 64 (8 x 8) or 128 (16 x 8).
#ifndef GROUP
#define GROUP 64
#endif
layout(local_size_x = GROUP) in;
const ivec2 tile_size = ivec2(GROUP > 64 ? 16 : 8, GROUP < 64 ? 4 : 8);

// Returns the place of the invocation's pixel in its tile.
ivec2 pixel_in_tile() {
    int place = int(gl_LocalInvocationID.x);
    return ivec2((place & 1) | (place >> 1 & 2) | (place >> 2 & 4) | (place >> 3 & 8),
                 (place >> 1 & 1) | (place >> 2 & 2) | (place >> 3 & 4));
}
