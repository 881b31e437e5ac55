// SPDX-License-Identifier: Apache-2.0
// Emission and absorption along a part of a ray on which the scalar is a cubic and the transfer
// function linear (docs/numerics.md, section 9).
#include "optics/cubic.glsl"
#include "optics/intervals.glsl"
#include "optics/opacity.glsl"

// Optical depth above which callers split a part: up to it seen_share() is accurate to .01 / 255.
const float largest_part_depth = 0.75;

// One interval of the transfer function. Colour and extinction are linear in the share: the
// position in the interval, 0 at its left end and 1 at its right.
struct Interval {
    float left_end, right_end;  // right_end of the last interval exceeds all scalars
    float inverse_width;
    float shown_beyond;         // extinction is 0 from left_end up to this scalar
    vec4 left, change;          // colour (rgb) and extinction (a) at the left end, and from there to the right
};

Interval interval_at(int number) {
    vec4 place = interval_place(number);
    vec4 left = interval_texel(number, 1);
    vec4 right = interval_texel(number, 2);
    vec2 ends = interval_texel(number, 3).ba;
    return Interval(place.x, ends.y, place.y, ends.x, left, right - left);
}

#ifdef SKIPS_HIDDEN_PARTS
// Tells, by one texel of the interval of its lowest scalar, whether nothing of a part shows. At the
// scalar `shown_beyond` itself the next interval may show, if there is a step.
bool is_hidden(int interval, vec2 range) { return range.y < interval_texel(interval, 3).b; }
#endif

// A part of a ray whose scalar stays in one interval. `share` holds the coefficients of the share
// as a cubic of t, which is 0 at the part's front and 1 at its back. `extinction` is the extinction
// at share 0 times the part's length; `change` is what this product gains from share 0 to share 1.
struct LinearPart {
    vec4 share;
    float extinction, change;
};

LinearPart linear_part(Interval interval, vec4 scalar, float world_length) {
    vec4 share = vec4(scalar.x - interval.left_end, scalar.yzw) * interval.inverse_width;
    return LinearPart(share, interval.left.a * world_length, interval.change.a * world_length);
}

// Returns the optical depth: exact, because the extinction is a cubic of t. The share may be less
// exact in a cell with samples far outside the transfer function's range.
float depth_of(LinearPart part) {
    return max(part.extinction + part.change * clamp(cubic_mean(part.share), 0.0, 1.0), 0.0);
}

// Returns 1 - exp(-depth) for depths up to largest_part_depth with a relative error of 2e-5: a
// polynomial that interpolates at Chebyshev nodes.
vec4 shallow_opacity(vec4 depth) {
    return depth * (0.99998385 + depth * (-0.49930894 + depth * (0.16195904 + depth * -0.031068699)));
}

// Returns the integral over the part of share * extinction * transmittance, which weights the
// change of colour. `opacity` is that of `depth`, the part's optical depth, at most
// largest_part_depth. Integration by parts leaves only the slope of the share to Gauss' rule of
// four points, so a constant share is exact.
float seen_share(LinearPart part, float depth, float opacity) {
    const vec4 nodes = vec4(0.069431844, 0.33000948, 0.66999052, 0.93056816);
    const vec4 weights = vec4(0.17392742, 0.32607258, 0.32607258, 0.17392742);
    vec4 share = part.share;
    float d0 = part.extinction + part.change * share.x;
    vec3 d = part.change * (share.yzw * vec3(1.0 / 2.0, 1.0 / 3.0, 1.0 / 4.0));
    vec4 before = nodes * (d0 + nodes * (d.x + nodes * (d.y + nodes * d.z)));
    vec4 slope = weights * (share.y + nodes * (2.0 * share.z + nodes * (3.0 * share.w)));
    float sum = opacity * share.x + dot(slope, shallow_opacity(vec4(depth)) - shallow_opacity(before));
    return clamp(sum, 0.0, opacity);
}
