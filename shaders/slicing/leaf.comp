#version 450 core
// SPDX-License-Identifier: Apache-2.0
// Draws a leaf of a compositing tree: composites its slabs along each pixel's ray, front to back, in
// registers. KEEPS_SUMS: several dispatches draw it, because it has more slabs than the driver's
// loops can march or lies in several bricks. A buffer keeps what the rays have passed between them.
#include "gl/pixels.glsl"
#include "slicing/segment.glsl"
#ifndef EXACT
#include "slicing/slab_march.glsl"
#endif
#include "slicing/node_output.glsl"

uniform float first_slab;  // slabs of the leaf that this dispatch draws
uniform float slab_count;

#ifdef KEEPS_SUMS
layout(std430, binding = 1) buffer KeptSums { float kept[]; };
uniform int kept_begin;       // place of the sum of pixel (0, 0)
uniform int kept_row;         // numbers in a row
uniform int first_dispatch;   // 1 for the leaf's first dispatch, else 0
uniform int last_dispatch;

#ifdef SINGLE_COLOR
int kept_place(ivec2 pixel) { return kept_begin + pixel.y * kept_row + pixel.x; }
RaySum kept_sum(int place) { return RaySum(vec3(0.0), kept[place], 1.0); }
void keep(int place, RaySum sum) { kept[place] = sum.depth; }
#else
int kept_place(ivec2 pixel) { return kept_begin + pixel.y * kept_row + 5 * pixel.x; }
RaySum kept_sum(int place) {
    return RaySum(vec3(kept[place], kept[place + 1], kept[place + 2]), kept[place + 3], kept[place + 4]);
}
void keep(int place, RaySum sum) {
    kept[place] = sum.color.r;
    kept[place + 1] = sum.color.g;
    kept[place + 2] = sum.color.b;
    kept[place + 3] = sum.depth;
    kept[place + 4] = sum.transmittance;
}
#endif
#endif

void draw(ivec2 pixel) {
    RaySum sum = empty_sum;
    Ray ray = view_ray(vec2(pixel) + 0.5);
    REAL2 whole = clip_to_box(ray, slab_depths(first_slab, slab_count));
#ifdef KEEPS_SUMS
    int place = kept_place(pixel);
    if (first_dispatch == 0) sum = kept_sum(place);
#ifdef ENDS_EARLY
    if (sum.depth >= opaque_depth) whole.y = whole.x;
#endif
#endif
#ifdef EXACT
    integrate_cells(ray, whole, sum);
#else
    if (whole.y > whole.x) march_slabs(ray, whole, first_slab, slab_count, sum);
#endif
#ifdef KEEPS_SUMS
    if (last_dispatch == 0) {
        keep(place, sum);
        return;
    }
#endif
    write_node(pixel, sum.color, sum.depth);
}

#include "gl/march.glsl"
