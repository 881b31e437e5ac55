// SPDX-License-Identifier: Apache-2.0
// A workgroup draws a tile of 8 x 8 pixels in Morton order: llvmpipe fills its lanes with consecutive
// invocations, and GPUs their warps, so that lanes and warps hold neighbours of the picture, whose
// rays take about the same way.
layout(local_size_x = 64) in;

// Returns the place of the invocation's pixel in its tile.
ivec2 pixel_in_tile() {
    int place = int(gl_LocalInvocationID.x);
    return ivec2((place & 1) | (place >> 1 & 2) | (place >> 2 & 4),
                 (place >> 1 & 1) | (place >> 2 & 2) | (place >> 3 & 4));
}
