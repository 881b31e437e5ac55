// SPDX-License-Identifier: Apache-2.0
// Gives each invocation of a compute shader a pixel. A workgroup draws a tile of 8 x 8 pixels in
// Morton order: llvmpipe fills its lanes with consecutive invocations, and GPUs their warps, so
// that lanes and warps hold neighbours of the picture, whose rays take about the same way.
layout(local_size_x = 64) in;

uniform ivec2 drawn_begin;  // column and row of the first pixel that is drawn; row 0 is at the top
uniform ivec2 drawn_end;    // behind the last one

ivec2 pixel_of_invocation() {
    int group = int(gl_WorkGroupID.x), place = int(gl_LocalInvocationID.x);
    int tiles_across = (drawn_end.x - drawn_begin.x + 7) / 8;
    ivec2 in_tile = ivec2((place & 1) | (place >> 1 & 2) | (place >> 2 & 4),
                          (place >> 1 & 1) | (place >> 2 & 2) | (place >> 3 & 4));
    return drawn_begin + 8 * ivec2(group % tiles_across, group / tiles_across) + in_tile;
}

// Tells whether a pixel is drawn: tiles at the edges have some that are not.
bool is_drawn(ivec2 pixel) { return all(lessThan(pixel, drawn_end)); }
