#version 450 core
// SPDX-License-Identifier: Apache-2.0
// A corner of a slab's polygon (slicing/slab_geometry.h).
layout(location = 0) in vec2 position;  // pixels from the image's left and top edge
layout(location = 1) in float slab_number;

uniform vec2 image_size;

flat out float slab;
#ifdef DITHER_PERIOD
uniform sampler2D dither_ranks;  // ranks of the slabs of a period, for alpha, then for colour; rows of 256
flat out uvec2 ranks;
uint rank_at(int place) { return uint(texelFetch(dither_ranks, ivec2(place & 255, place >> 8), 0).r); }
#endif

void main() {
    slab = slab_number;
#ifdef DITHER_PERIOD
    int place = int(slab_number) % DITHER_PERIOD;
    ranks = uvec2(rank_at(place), rank_at(DITHER_PERIOD + place));
#endif
    vec2 device = 2.0 * position / image_size - 1.0;
    gl_Position = vec4(device.x, -device.y, 0.0, 1.0);
}
