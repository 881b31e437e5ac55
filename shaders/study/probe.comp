// SPDX-License-Identifier: Apache-2.0
#version 450 core

// Runs the probe for all pixels: MORTON: along a Morton curve in tiles of 16 x 16 pixels, a tile after
// the other; else row by row.
layout(local_size_x = GROUP) in;
#include "study/probe.glsl"
layout(std430, binding = 1) writeonly buffer Results { float results[]; };
uniform ivec2 size;   // of the picture

void main() {
    int index = int(gl_GlobalInvocationID.x), tiles_x = (size.x + 15) / 16;
#ifdef MORTON
    int in_tile = index & 255, tile = index >> 8;
    ivec2 bits = ivec2(in_tile, in_tile >> 1) & 0x55;
    bits = (bits | bits >> 1) & 0x33;
    ivec2 pixel = ivec2(tile % tiles_x, tile / tiles_x) * 16 + ((bits | bits >> 2) & 15);
#else
    ivec2 pixel = ivec2(index % (16 * tiles_x), index / (16 * tiles_x));
#endif
    if (all(lessThan(pixel, size))) results[pixel.y * size.x + pixel.x] = probe(pixel);
}
