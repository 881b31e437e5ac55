#version 450 core
// SPDX-License-Identifier: Apache-2.0
// Draws a leaf of a compositing tree: composites all of its slabs along the fragment's ray, front
// to back, in registers. ACCUMULATE: it composites only the slabs in one of several bricks, and is
// blended into a float target, from which slicing/encode.frag makes the leaf's image.
#include "slicing/segment.glsl"
#ifndef EXACT
#include "slicing/slab_march.glsl"
#endif
#ifdef ACCUMULATE
layout(location = 0) out vec4 associated;
#else
#include "slicing/node_output.glsl"
#endif

uniform float leaf_slabs;
flat in float slab;  // number of the leaf's first slab

void main() {
    Ray ray = view_ray(gl_FragCoord.xy);
    REAL2 whole = clip_to_box(ray, slab_depths(slab, leaf_slabs));
    if (!(whole.y > whole.x)) discard;
    vec3 color;
    float depth;
#ifdef EXACT
    integrate_cells(ray, whole, color, depth);
#else
    march_slabs(ray, whole, slab, leaf_slabs, color, depth);
#endif
#ifdef ACCUMULATE
    float opacity = opacity_from_depth(depth);
#ifdef MONOCHROME
    color = single_color * opacity;
#endif
    associated = vec4(color, opacity);
#else
    write_node(color, depth);
#endif
}
