// SPDX-License-Identifier: Apache-2.0
#include "optics/opacity.glsl"
#include "optics/intervals.glsl"
#if defined(TABLE_COLORED) && defined(FRONT_WEIGHT_NODES)
#include "optics/linear_segment.glsl"
#elif defined(TABLE_COLORED)
#include "optics/piece_weights.glsl"
#else
uniform vec3 single_color;
#endif

// The interval of the scalar at which integrate_segment() ended last, and its number.
Interval interval = Interval(1.0, 0.0, 0.0, 0.0, vec4(0.0), vec4(0.0));
int interval_number;

void take_interval(int number) {
    interval_number = number;
    interval = interval_at(number);
}

void find_interval_of(float scalar) {
    bool known = scalar >= interval.left_end && scalar < interval.right_end;
    // A loop, because software rasterisers skip loops but not branches.
    for (; !known; known = true) take_interval(find_interval(scalar));
}

float share_of(float scalar) { return clamp((scalar - interval.left_end) * interval.inverse_width, 0.0, 1.0); }

// Returns the associated colour and opacity of a segment on which the scalar changes linearly from
// `front` to `back`, both normalised so that the intervals of the transfer function cover [0, 1];
// below 0 and above 1 the optics at the two ends hold. Integrates exactly, interval by interval
// (docs/numerics.md, section 5). TABLE_COLORED: colours come from the transfer function; otherwise
// the colour is `single_color`. LIT: adds light_on_piece(), which the including shader must define
// before it includes analytic_segment.glsl. This is the twin of integrate_segment()
// (optics/segment_integral.h) in float32. FRONT_WEIGHT_NODES: weights of colours come from a table. The optical depth is a sum of terms >= 0, so no digits
// cancel. Extinction times length is finite for lengths up to 1e8 (executors/transfer_tables.h).
vec4 integrate_segment(float front, float back, float world_length) {
    find_interval_of(clamp(front, 0.0, 1.0));
    bool rising = front <= back;
#ifdef LIT
    float from = 0.0;  // where the piece begins, as a fraction of the segment
#endif
    float length_per_scalar = world_length / abs(back - front);

    float scalar = front;
    float depth = 0.0;
#ifdef TABLE_COLORED
    vec3 color = vec3(0.0);
    float transmittance = 1.0;
#endif
    for (bool whole = true, first = true; whole; first = false) {
        // The ray passes on into the next interval.
        whole = rising ? back >= interval.right_end : back < interval.left_end && interval_number > 0;
        float next_scalar = !whole ? back : rising ? interval.right_end : interval.left_end;
        vec4 near = interval.left + share_of(scalar) * interval.change;
        vec4 far = interval.left + share_of(next_scalar) * interval.change;
        bool one_piece = first && !whole;  // also covers front == back
        float part = one_piece ? world_length : length_per_scalar * abs(next_scalar - scalar);
        float p = near.a * part, q = far.a * part;
        float piece_depth = 0.5 * p + 0.5 * q;
        depth += piece_depth;
#ifdef TABLE_COLORED
        float opacity = opacity_from_depth(piece_depth);
        float weight = front_weight(p, q);
        color += transmittance * (weight * near.rgb + max(opacity - weight, 0.0) * far.rgb);
#ifdef LIT
        float to = whole ? abs(next_scalar - front) / abs(back - front) : 1.0;
        color += light_on_piece(from, to, vec2(p, q), near.rgb, far.rgb, transmittance);
        from = to;
#endif
        transmittance *= 1.0 - opacity;
#endif
        scalar = next_scalar;
        for (bool there = !whole; !there; there = true) take_interval(interval_number + (rising ? 1 : -1));
    }
#ifdef TABLE_COLORED
#ifdef LIT
    color = max(color, 0.0);  // rounding may make it negative
#endif
    return vec4(color, opacity_from_depth(depth));
#else
    return vec4(single_color, 1.0) * opacity_from_depth(depth);
#endif
}
