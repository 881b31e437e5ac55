#version 450 core
// SPDX-License-Identifier: Apache-2.0
// A leaf of a compositing tree: composites all of its slabs along the fragment's ray, front to back, in registers.
// ACCUMULATE: only those of one of several bricks, for blending into a float target; slicing/encode.frag makes the
// leaf's image of the sum. OCCUPIED_ONLY: leaps over empty space. ENDS_EARLY: ends the ray where the rest cannot be
// seen.
#include "slicing/segment.glsl"
#ifdef OCCUPIED_ONLY
#include "slicing/empty_space.glsl"
#endif
#ifdef ENDS_EARLY
uniform float opaque_depth;
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
    REAL2 whole = clip_to_box(ray, slab_depths(slab, leaf_slabs), box_min, box_max);
    if (!(whole.y > whole.x)) discard;
    float first = max(slab, floor(float(whole.x / slab_thickness)) - 1.0);
    float end = min(slab + leaf_slabs, ceil(float(whole.y / slab_thickness)) + 1.0);
    // These are sums of thousands of small terms, in double with PRECISE_RAYS.
    REAL3 color = REAL3(0.0);
    REAL depth = REAL(0.0);
    REAL transmittance = REAL(1.0);
#ifdef PREINTEGRATED
    float front = sample_scalar(point_at(ray, whole.x));
#endif
#ifdef OCCUPIED_ONLY
    BrickRay bricks = brick_ray(ray, whole.x);
    float shown_end = first;  // slabs before this may show something
#endif
    for (float i = first; i < end; ++i) {
#ifdef OCCUPIED_ONLY
        float here = i;
        while (i >= shown_end && i < end) {
            Stretch stretch = next_stretch(bricks, i);
            if (stretch.shown) shown_end = stretch.end;
            else i = stretch.end;
        }
        if (i >= end) break;
#ifdef PREINTEGRATED
        // After a leap, the last empty slab gives the scalar at the front.
        bool leapt = i > here;
        if (leapt) i -= 1.0;
#endif
#endif
        REAL2 depths = slab_depths(i, 1.0);
        depths = REAL2(max(depths.x, whole.x), min(depths.y, whole.y));
        if (!(depths.y > depths.x)) continue;
#ifdef PREINTEGRATED
        float back = sample_scalar(point_at(ray, depths.y));
        Segment segment = integrate_samples(front, sample_scalar(point_at(ray, 0.5 * (depths.x + depths.y))), back,
                                            float(world_length(ray, depths)));
        front = back;
#ifdef OCCUPIED_ONLY
        if (leapt) segment.depth = DEPTH(0.0);
#endif
#else
        Segment segment = integrate(ray, depths);
#endif
        depth += REAL(segment.depth);
#ifndef MONOCHROME
        REAL weight = transmittance * REAL(opacity_from_depth(segment.depth));
        color += weight * REAL3(segment.color);
        transmittance -= weight;
#endif
#ifdef ENDS_EARLY
        if (float(depth) >= opaque_depth) break;
#endif
    }
#ifdef ACCUMULATE
    float opacity = opacity_from_depth(float(depth));
#ifdef MONOCHROME
    color = REAL3(single_color * opacity);
#endif
    associated = vec4(vec3(color), opacity);
#else
    write_node(vec3(color), float(depth));
#endif
}
