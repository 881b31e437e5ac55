// SPDX-License-Identifier: Apache-2.0
// Composites the slabs of a leaf along a ray, front to back, in registers. OCCUPIED_ONLY: leaps
// over empty space. ENDS_EARLY: ends the ray once nothing behind is visible.
#include "slicing/ray_sum.glsl"
#ifdef OCCUPIED_ONLY
#include "slicing/empty_space.glsl"
#endif
#ifdef ENDS_EARLY
uniform float opaque_depth;
#endif

// Adds the part of a ray between the depths `whole` to what the ray has passed. It lies in slabs
// slab .. slab + slabs - 1.
void march_slabs(Ray ray, REAL2 whole, float slab, float slabs, inout RaySum sum) {
    vec2 range = slabs_of(whole, slab, slabs);
    float first = range.x, end = range.y;
    // These are sums of thousands of small terms. With PRECISE_RAYS they are double.
    REAL3 color = REAL3(sum.color);
    REAL depth = REAL(sum.depth);
    REAL transmittance = REAL(sum.transmittance);
#ifdef PREINTEGRATED
    float front = sample_scalar(point_at(ray, whole.x));
#ifdef LIGHTS
    LitEnd lit_end = unknown_end();
#endif
#endif
#ifdef OCCUPIED_ONLY
    BrickRay bricks = brick_ray(ray, whole.x);
    float shown_end = first;  // slabs i before this one may be visible
#endif
    for (float i = first; i < end; ++i) {
#ifdef OCCUPIED_ONLY
        float here = i;
        while (i >= shown_end && i < end) {
            SlabRange range = next_slab_range(bricks, i);
            if (range.shown) shown_end = range.end;
            else i = range.end;
        }
        if (i >= end) break;
#ifdef PREINTEGRATED
        // After a leap, the last empty slab is evaluated only for the scalar at its back, which is
        // that at the front of the next one.
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
#ifdef LIGHTS
        light_segment(ray, depths, lit_end, segment);
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
    sum = RaySum(vec3(color), float(depth), float(transmittance));
}
