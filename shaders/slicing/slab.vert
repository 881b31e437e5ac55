#version 450 core
// SPDX-License-Identifier: Apache-2.0
// A corner of a slab's polygon (slicing/slab_geometry.h).
layout(location = 0) in vec2 position;  // pixels from the image's left and top edge
layout(location = 1) in float slab_number;

uniform vec2 image_size;

flat out float slab;
#ifdef BITS
flat out uvec2 ranks;
#endif
#ifdef DITHER_PERIOD
#include "slicing/dither_ranks.glsl"
#endif

void main() {
    slab = slab_number;
#ifdef DITHER_PERIOD
    ranks = ranks_of(int(slab_number));
#elif defined(BITS)
    ranks = uvec2(0u);
#endif
    vec2 device = 2.0 * position / image_size - 1.0;
    gl_Position = vec4(device.x, -device.y, 0.0, 1.0);
}
