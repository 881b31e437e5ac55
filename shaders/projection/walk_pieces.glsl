// SPDX-License-Identifier: Apache-2.0
// The interval of the transfer function in which the scalar of a walking ray lies. At its ends `low_optics` and
// `high_optics` hold: colour and extinction, or extinction alone.
#include "optics/intervals.glsl"

int interval;
float left_end, inverse_width;
vec2 interval_ends;  // the first interval begins, and the last ends, beyond all scalars

#ifdef TABLE_COLORED
#define OPTICS_OF(texel) (texel)
#else
#define OPTICS_OF(texel) (texel).a
#endif

void take_interval(int number) {
    interval = number;
    vec4 place = interval_place(number);
    left_end = place.x;
    inverse_width = place.y;
    float right_end = interval_texel(number, 3).a;
    interval_ends = vec2(number == 0 ? -3e38 : left_end, right_end);
    low_optics = OPTICS_OF(interval_texel(number, 1));
    high_optics = OPTICS_OF(interval_texel(number, 2));
}

float share_of_interval(float scalar) { return clamp((scalar - left_end) * inverse_width, 0.0, 1.0); }

// Returns the share of a piece, from its front on, that has the optical depth up to which the weight of its colours is
// a polynomial (optics/linear_segment.glsl); 1 if all of it has less. Solves p t + (q - p) t^2 / 2 = goal, divided by
// the whole depth so that nothing overflows.
float thin_share(float p, float q) {
    const float goal = 1.5;
    float depth = 0.5 * p + 0.5 * q;
    float slope = p / depth, share = goal / depth;
    float root = sqrt(max(slope * slope + 2.0 * share * (q / depth - slope), 0.0));
    return depth > goal ? min(2.0 * share / max(slope + root, 1e-18), 1.0) : 1.0;
}
