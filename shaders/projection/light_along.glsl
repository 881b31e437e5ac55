// SPDX-License-Identifier: Apache-2.0
// Light along a segment on which extinction and gradient are linear: twin of LightAlong in
// projection/cpu_lit_fragments.cpp.
#include "optics/opacity.glsl"
#include "optics/lighting.glsl"

// The square of the smallest gradient, and the largest bend of light (executors/lights.h).
uniform vec2 light_limits;

// A lit segment, or the piece of one on which the transfer function is linear.
struct LitSegment {
    vec2 depths;  // extinction at both ends, times the length
    vec3 gradient, turn;  // gradient at the front, and its change from there to the back
    vec3 to_eye;
};

// The contribution of light: with the colour f at the front of a segment and b at its back, light
// adds f * change + (b - f) * farther + highlight.
struct LightSums {
    LIGHT_COLOR change, farther, highlight;
};

vec3 light_added(LightSums sums, vec3 front, vec3 back) {
    return front * sums.change + (back - front) * sums.farther + vec3(sums.highlight);
}

float largest_of(float v) { return abs(v); }
float largest_of(vec3 v) { return max(max(abs(v.x), abs(v.y)), abs(v.z)); }

// Returns a bound on the bend of light (its second difference at the three nodes) within a piece that the nodes may not
// show.
float hidden_bend(LitSegment segment, float at, float extent) {
    vec3 center = segment.gradient + (at + 0.5 * extent) * segment.turn;
    vec3 reach = 0.5 * extent * segment.turn;
    return hidden_effect(dot(center, center), dot(reach, reach), light_limits.x);
}

// Returns the place behind `at` at which the gradient is perpendicular to the light, 2 if there is
// none.
float kink_behind(LitSegment segment, float at, int light) {
    vec3 to_light = direction_to_light(light, segment.to_eye);
    float from = dot(segment.gradient, to_light), change = dot(segment.turn, to_light);
    float kink = from * (from + change) < 0.0 ? -from / change : 2.0;
    return kink - at > 1e-6 ? kink : 2.0;
}

float next_kink(LitSegment segment, float at) {
    float kink = 2.0;
#define TAKE_NEARER(i) kink = min(kink, kink_behind(segment, at, i));
    FOR_EACH_LIGHT(TAKE_NEARER)
#undef TAKE_NEARER
    return kink;
}

// Adds a node of Gauss' rule, of weight `amount`, to the sums; returns change and highlight together.
LIGHT_COLOR add_node(LitSegment segment, float place, float amount, inout LightSums sums) {
    LightEffect effect = light_effect(segment.gradient + place * segment.turn, light_limits.x, segment.to_eye);
    sums.change += amount * effect.change;
    sums.farther += amount * place * effect.change;
    sums.highlight += amount * effect.highlight;
    return effect.change + effect.highlight;
}

// Returns the contribution of light to a segment, piece by piece from the front. Pieces end at kinks, and are as short
// as depth and bend of light demand. `in_front`: transmittance in front of the segment. Optical depths: `deepest` keeps
// products finite, and pieces deeper than `shallow` are cut to `goal`.
LightSums light_along(LitSegment segment, float in_front) {
    const float deepest = 1e12, shallow = 0.75, goal = 0.7;
    LightSums sums = LightSums(LIGHT_COLOR(0.0), LIGHT_COLOR(0.0), LIGHT_COLOR(0.0));
    float at = 0.0, longest = 1.0;
    float first = min(segment.depths.x, deepest), change = min(segment.depths.y, deepest) - first;
    if (!(2.0 * first + change > 0.0)) return sums;
    while (at < 1.0 && in_front > 1e-5) {
        float rest = 1.0 - at;
        float front = max(first + change * at, 0.0);
        float extent = min(min(longest, rest), next_kink(segment, at) - at);
        // Cuts deep pieces to the depth of a shallow one: a quadratic equation, in the form without
        // cancellation.
        if (extent * (front + 0.5 * change * extent) > shallow) {
            float root = sqrt(max(front * front + 2.0 * goal * change, 0.0));
            extent = min(max(2.0 * goal / max(front + root, 1e-30), 1e-6), rest);
        }
        bool last = extent >= rest;
        float depth = max(extent * (front + 0.5 * change * extent), 0.0);
        float opacity = opacity_from_depth(depth);

        // Gauss' rule with three nodes, whose weights add up to the piece's opacity.
        vec3 along = extent * vec3(0.11270167, 0.5, 0.88729833);
        vec3 before = along * (front + 0.5 * change * along);
        vec3 amounts = vec3(0.27777778, 0.44444444, 0.27777778) * max(front + change * along, 0.0) * exp(-before);
        amounts = depth > shallow ? vec3(1.0, 0.0, 0.0) : amounts;
        LightSums piece = LightSums(LIGHT_COLOR(0.0), LIGHT_COLOR(0.0), LIGHT_COLOR(0.0));
        LIGHT_COLOR bends = add_node(segment, at + along.x, amounts.x, piece);
        bends -= 2.0 * add_node(segment, at + along.y, amounts.y, piece);
        bends += add_node(segment, at + along.z, amounts.z, piece);
        float bend = max(hidden_bend(segment, at, extent), largest_of(bends));

        float weight = in_front * opacity;
        float most = light_limits.y;
        if (bend > most && bend * weight > 0.25 * most && extent > 0.00390625) {
            longest = extent * clamp(sqrt(most / bend), 0.125, 0.5);
            continue;
        }
        float scale = weight / (amounts.x + amounts.y + amounts.z + 1e-37);
        sums.change += scale * piece.change;
        sums.farther += scale * piece.farther;
        sums.highlight += scale * piece.highlight;
        in_front -= weight;
        at = last ? 1.0 : at + extent;
        longest = max(longest, 2.0 * extent);
    }
    return sums;
}
