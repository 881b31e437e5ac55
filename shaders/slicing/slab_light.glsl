// SPDX-License-Identifier: Apache-2.0
// Adds light to segments of slabs: at the sample in the middle, or at both ends and linear between
// them (docs/numerics.md, section 10). The engine `cpu` does this in
// slicing/cpu_slab_segments.cpp.
#include "optics/lighting.glsl"
#include "volume/gradient.glsl"

// Interpolates the gradients at the corners of a cell along x.
vec3 mix_x(CornerGradients corners, int row, float share) {
    return mix(corners.lower_x[row], corners.upper_x[row], share);
}

// Returns the effect of light at a depth of a ray. Beyond the samples (`cell` axes) the gradient of
// the border repeats.
LightEffect light_at(Ray ray, REAL depth) {
    vec3 point = clamp(point_at(ray, depth), vec3(0.0), last_sample);
    ivec3 lower = ivec3(min(point, max(last_sample - 1.0, 0.0)));
    ivec3 upper = min(lower + 1, ivec3(last_sample));
    vec3 share = point - vec3(lower);
    // Beyond the last samples only the upper corners count. The lower ones may be so long that
    // adding and subtracting them would lose all digits.
    lower = ivec3(mix(vec3(lower), vec3(upper), greaterThanEqual(share, vec3(1.0))));
    CornerGradients corners = corner_gradients(lower, upper);
    vec3 near = mix(mix_x(corners, 0, share.x), mix_x(corners, 1, share.x), share.y);
    vec3 far = mix(mix_x(corners, 2, share.x), mix_x(corners, 3, share.x), share.y);
    vec3 to_eye = -normalize(vec3(ray.direction) * spacing);
    return light_effect(mix(near, far, share.z), smallest_square_in_unit(corners.largest), to_eye);
}

#ifndef PREINTEGRATED
// Lights a segment whose scalar is that at `depth`. This is a loop and not an if, because software
// rasterisers compute both sides of branches.
void light_segment(Ray ray, REAL depth, inout Segment segment) {
    int lit = segment.depth > DEPTH(0.0) ? 1 : 0;
    for (int i = 0; i < lit; ++i) {
        LightEffect effect = light_at(ray, depth);
        segment.color = max(segment.color + segment.color * effect.change + effect.highlight, 0.0);
    }
}
#else
// The effect of light at the point where a segment begins or ends, if it is known from the segment
// before.
struct LitEnd {
    LightEffect effect;
    bool known;
};

LitEnd unknown_end() { return LitEnd(LightEffect(LIGHT_COLOR(0.0), LIGHT_COLOR(0.0)), false); }

// Lights a segment between two depths. `end`: the light at the segment's front, if known; on return
// the light at its back.
void light_segment(Ray ray, REAL2 depths, inout LitEnd end, inout Segment segment) {
    bool shows = segment.depth > DEPTH(0.0);
    LightEffect front = end.effect;
    int passes = shows ? 2 : 0;
    for (int pass = end.known ? 1 : 0; pass < passes; ++pass) {
        front = end.effect;
        end.effect = light_at(ray, pass == 0 ? depths.x : depths.y);
    }
    end.known = shows;
    if (!shows) return;
    vec3 changed = segment.color * end.effect.change + segment.front.rgb * (front.change - end.effect.change);
    vec3 highlight = vec3(end.effect.highlight + segment.front.a * (front.highlight - end.effect.highlight));
    segment.color = max(segment.color + changed + highlight, 0.0);
}
#endif
