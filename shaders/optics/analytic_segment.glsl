// SPDX-License-Identifier: Apache-2.0
#include "optics/opacity.glsl"
#include "optics/transfer_function.glsl"
#ifdef TABLE_COLORED
#include "optics/piece_weights.glsl"
#else
uniform vec3 single_color;
#endif

// Returns the associated colour and opacity of a segment on which the scalar changes linearly from
// `front` to `back`, both normalised so that the intervals of the transfer function cover [0, 1];
// below 0 and above 1 the optics at the two ends hold. Integrates exactly, interval by interval
// (docs/numerics.md, section 5). TABLE_COLORED: colours come from the transfer function; otherwise
// the colour is `single_color`. LIT: adds light_on_piece(), which the including shader must define
// before it includes analytic_segment.glsl. This is the twin of integrate_segment()
// (optics/segment_integral.h) in float32. The optical depth is a sum of terms >= 0, so no digits
// cancel. Extinction times length is finite for lengths up to 1e8 (executors/transfer_tables.h).
vec4 integrate_segment(float front, float back, float world_length) {
    int interval = find_interval(clamp(front, 0.0, 1.0));
    int last = find_interval(clamp(back, 0.0, 1.0));
    int step = interval <= last ? 1 : -1;
    float end_share = step > 0 ? 1.0 : 0.0;  // position in an interval where the ray leaves it
    bool one_piece = interval == last;  // also covers front == back
#ifdef LIT
    float from = 0.0;  // where the piece begins, as a fraction of the segment
#endif
    float length_per_scalar = world_length / abs(back - front);

    float scalar = front;
    // Position in the current interval where the piece begins: 0 at its left end, 1 at its right.
    float share = share_of_interval(interval_place(interval), front);
    float depth = 0.0;
#ifdef TABLE_COLORED
    vec3 color = vec3(0.0);
    float transmittance = 1.0;
#endif
    // `left` counts the intervals that follow the current one.
    for (int left = abs(last - interval); left >= 0; --left) {
        bool whole = left > 0;  // the ray passes on into the next interval
        float next_scalar = whole ? interval_place(interval + max(step, 0)).x : back;
        float next_share = whole ? end_share : share_of_interval(interval_place(interval), back);
        vec4 near = optics_at(interval, share);
        vec4 far = optics_at(interval, next_share);
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
        share = 1.0 - end_share;
        interval += step;
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
