// SPDX-License-Identifier: Apache-2.0
// integrate() computes the colour, not associated, and the optical depth of the part of a ray
// between two depths. It has one form for each classification. DEPTH is the type of the optical
// depth; codes of n bits need double.
#define SAMPLING_NONE 0
#define SAMPLING_FETCH 1
#define SAMPLING_FILTER 2
#ifdef BITS
#define DEPTH double
#else
#define DEPTH float
#endif

#include "slicing/ray.glsl"
#include "optics/opacity.glsl"
#ifdef EXACT
#include "slicing/exact_segment.glsl"
#else
#include "volume/scalar.glsl"
#endif
#if SAMPLING == SAMPLING_NONE
uniform vec4 constant_optics;  // colour, extinction
uniform float constant_extinction_low;
#elif defined(PREINTEGRATED) && !defined(LINEAR)
#include "preintegration/knot_table.glsl"
#elif !defined(EXACT)
#include "optics/transfer_function.glsl"
#endif
#if defined(LINEAR) && !defined(SINGLE_COLOR)
#define TABLE_COLORED
#define THIN
#include "optics/linear_segment.glsl"
#endif
#ifdef SINGLE_COLOR
uniform vec3 single_color;
#endif

struct Segment {
    vec3 color;
    DEPTH depth;
#ifdef TABLE_LIT
    vec4 front;  // front parts (optics/segment_integral.h) of colour and opacity, divided by opacity
#endif
};

Segment segment_of(vec3 color, DEPTH depth) {
    Segment segment;
    segment.color = color;
    segment.depth = depth;
#ifdef TABLE_LIT
    segment.front = vec4(0.0);
#endif
    return segment;
}

#if defined(LIGHTS) && !defined(EXACT)
#include "slicing/slab_light.glsl"
#endif

REAL world_length(Ray ray, REAL2 depths) { return (depths.y - depths.x) * ray.length_per_depth; }

vec3 color_or_single(vec3 color) {
#ifdef SINGLE_COLOR
    return single_color;
#else
    return color;
#endif
}

#if SAMPLING == SAMPLING_NONE
Segment integrate(Ray ray, REAL2 depths) {
    DEPTH extinction = DEPTH(constant_optics.a) + DEPTH(constant_extinction_low);
    return Segment(color_or_single(constant_optics.rgb), extinction * DEPTH(world_length(ray, depths)));
}
#elif defined(EXACT)
Segment integrate(Ray ray, REAL2 depths) {
    RaySum sum = empty_sum;
    integrate_cells(ray, depths, sum);
    return Segment(color_or_single(sum.color / max(opacity_from_depth(sum.depth), 1e-37)), DEPTH(sum.depth));
}
#elif defined(PREINTEGRATED)
#ifdef LINEAR
// Integrates in closed form, for transfer functions of one linear piece.
Segment integrate_linear_run(float front, float back, float world_length) {
    vec4 piece = interval_place(0);
    vec2 shares = vec2(share_of_interval(piece, front), share_of_interval(piece, back));
    float p = optics_at(0, shares.x).a * world_length, q = optics_at(0, shares.y).a * world_length;
    float depth = 0.5 * p + 0.5 * q;
#ifdef SINGLE_COLOR
    return Segment(single_color, DEPTH(depth));
#else
    float opacity = opacity_from_depth(depth);
    float of_front = min(front_weight(p, q), opacity) / max(opacity, 1e-37);
    return Segment(optics_at(0, shares.y + of_front * (shares.x - shares.y)).rgb, DEPTH(depth));
#endif
}
#endif

// Integrates a segment whose scalars at both ends and in the middle are known.
Segment integrate_samples(float front, float middle, float back, float world_length) {
#ifdef NAN_TRANSPARENT
    if (is_nan(front) || is_nan(middle) || is_nan(back)) return segment_of(vec3(0.0), DEPTH(0.0));
#endif
#ifndef LINEAR
    // A segment is empty if the transfer function shows nothing between the least and the largest
    // sample. Omitting empty space relies on this.
    float least = clamp(min(middle, min(front, back)), 0.0, 1.0);
    float largest = clamp(max(middle, max(front, back)), 0.0, 1.0);
    bool transparent = is_transparent(least, largest);
#endif
    // The table and the closed form integrate a scalar that is linear along the segment, but the
    // trilinear field is curved. So the line from front to back is moved to have the mean of the
    // parabola through the three samples (Simpson's rule, exact for the cubic of one cell). If
    // extinction is linear in the scalar, the optical depth is then right to fourth order instead
    // of second.
    float bend = (2.0 / 3.0) * (middle - 0.5 * (front + back));
    front = clamp(front + bend, 0.0, 1.0);
    back = clamp(back + bend, 0.0, 1.0);
#ifdef LINEAR
    return integrate_linear_run(front, back, world_length);
#else
    RunSum run = integrate_run(front, back, world_length, transparent);
    vec4 whole = run.whole;
    Segment segment = segment_of(vec3(0.0), DEPTH(whole.a));
#ifndef SINGLE_COLOR
    if (whole.a > 0.0) {
        float opacity = opacity_from_depth(whole.a);
        whole.rgb /= opacity;
#ifdef TABLE_LIT
        segment.front = run.front / opacity;
#endif
    }
#endif
    segment.color = color_or_single(whole.rgb);
    return segment;
#endif
}

Segment integrate(Ray ray, REAL2 depths) {
    Segment segment = integrate_samples(sample_scalar(point_at(ray, depths.x)),
                                        sample_scalar(point_at(ray, 0.5 * (depths.x + depths.y))),
                                        sample_scalar(point_at(ray, depths.y)), float(world_length(ray, depths)));
#ifdef LIGHTS
    LitEnd end = unknown_end();
    light_segment(ray, depths, end, segment);
#endif
    return segment;
}
#else
Segment integrate(Ray ray, REAL2 depths) {
    REAL middle = 0.5 * (depths.x + depths.y);
    float scalar = sample_scalar(point_at(ray, middle));
#ifdef NAN_TRANSPARENT
    if (is_nan(scalar)) return Segment(vec3(0.0), DEPTH(0.0));
#endif
    scalar = clamp(scalar, 0.0, 1.0);
    int interval = find_interval(scalar);
    float share = share_of_interval(interval_place(interval), scalar);
    vec4 optics = optics_at(interval, share);
#ifdef BITS
    DEPTH extinction = precise_extinction_at(interval, share);
#else
    DEPTH extinction = optics.a;
#endif
    Segment segment = Segment(color_or_single(optics.rgb), extinction * DEPTH(world_length(ray, depths)));
#ifdef LIGHTS
    light_segment(ray, middle, segment);
#endif
    return segment;
}
#endif
