#version 450 core
// SPDX-License-Identifier: Apache-2.0
// A leaf of a compositing tree: composites all of its slabs along the fragment's ray, front to back, in registers.
// ACCUMULATE: only those of one of several bricks, for blending into a float target; slicing/encode.frag makes the
// leaf's image of the sum.
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
flat in float slab;  // the first

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
