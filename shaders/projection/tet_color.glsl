// SPDX-License-Identifier: Apache-2.0
// Returns associated colour and opacity of the segment of a fragment's ray inside its tet, computed as SOURCE says.
// TABLE, CUT_TABLE: looks it up in a pre-integration table, whose nodes are equidistant or lie at the transfer
// function's points. PARTS: the cell fragment lies in one interval of the transfer function, so opacity has a closed
// form and colour takes one look-up. ANALYTIC: integrates interval by interval. MEAN, VERTICES: see below.
#include "optics/opacity.glsl"
#ifdef LIT
#include "projection/light_along.glsl"
#endif

#if SOURCE == SOURCE_CUT_TABLE || SOURCE == SOURCE_TABLE
// Returns the colour of a segment whose scalars lie in [0, 1].
vec4 color_within(float front, float back, float world_length);

vec4 tet_color() {
    FragmentSegment segment = find_segment();
    float front = clamp(segment.front, 0.0, 1.0), back = clamp(segment.back, 0.0, 1.0);
#ifdef WINDOWED
    // The pieces of the segment before the window, within it and behind it; the transfer function is constant outside
    // the window. They are added in a loop, because LLVM takes minutes to compile three copies of the look-ups.
    vec3 lengths = vec3(0.0, segment.world_length, 0.0);
    if (front != back && (front != segment.front || back != segment.back)) {
        float per_scalar = segment.world_length / abs(segment.back - segment.front);
        lengths = per_scalar * vec3(abs(front - segment.front), abs(back - front), abs(segment.back - back));
    }
    vec4 sum = vec4(0.0);
    int last = lengths[2] > 0.0 ? 2 : 1;
    for (int i = lengths[0] > 0.0 ? 0 : 1; i <= last; ++i)
        sum += (1.0 - sum.a) * color_within(i < 2 ? front : back, i > 0 ? back : front, lengths[i]);
    return sum;
#else
    return color_within(front, back, segment.world_length);
#endif
}
#endif

#if SOURCE == SOURCE_CONSTANT
vec4 tet_color() {
    float opacity = opacity_from_depth(constant_optics.a * find_segment().world_length);
    return vec4(constant_optics.rgb * opacity, opacity);
}
#elif SOURCE == SOURCE_PARTS
#include "optics/linear_segment.glsl"
#ifdef LIT
vec4 integrate_lit(vec4 front, vec4 back, FragmentSegment segment) {
    vec4 unlit = integrate_linear(front, back, segment.world_length);
    LitSegment lit = LitSegment(vec2(front.a, back.a) * segment.world_length, segment.front_gradient,
                                segment.back_gradient - segment.front_gradient, segment.to_eye);
    vec3 added = light_added(light_along(lit, 1.0), front.rgb, back.rgb);
    return vec4(max(unlit.rgb + added, 0.0), unlit.a);  // rounding may leave less than 0
}
#endif
vec4 tet_color() {
    FragmentSegment segment = find_segment();
    OPTICS front = low_optics + segment.front * (high_optics - low_optics);
    OPTICS back = low_optics + segment.back * (high_optics - low_optics);
#ifdef LIT
    return integrate_lit(front, back, segment);
#else
    return integrate_linear(front, back, segment.world_length);
#endif
}
#elif SOURCE == SOURCE_MEAN
// Stein, Becker, Max 1994: extinction is linear in the tet, so its mean over the ray is the mean of front and back.
// The colour is the mean of both, too.
vec4 tet_color() {
    TetOptics optics = find_optics();
    float opacity = opacity_from_depth(0.5 * (optics.front.a + optics.back.a) * optics.world_length);
    return vec4(0.5 * (optics.front.rgb + optics.back.rgb) * opacity, opacity);
}
#elif SOURCE == SOURCE_VERTICES
// Shirley, Tuchman 1990: colour and opacity of the vertices are interpolated.
vec4 tet_color() {
    vec4 values = clamp(vertex_values(), 0.0, 1.0);  // on slivers, rasterisers interpolate beyond the corners' values
    return vec4(values.rgb * values.a, values.a);
}
#elif SOURCE == SOURCE_CUT_TABLE
#include "preintegration/knot_table.glsl"
#ifndef TABLE_COLORED
uniform vec3 single_color;
#endif
vec4 color_within(float front, float back, float world_length) {
    vec4 sum = integrate_run(front, back, world_length, is_transparent(min(front, back), max(front, back))).whole;
    float opacity = opacity_from_depth(sum.a);
#ifdef TABLE_COLORED
    return vec4(sum.rgb, opacity);
#else
    return vec4(single_color * opacity, opacity);
#endif
}
#elif SOURCE == SOURCE_TABLE
#include "preintegration/uniform_table.glsl"
vec4 color_within(float front, float back, float world_length) { return integrate_segment(front, back, world_length); }
#elif SOURCE == SOURCE_ANALYTIC
#ifdef LIT
vec3 segment_gradient, segment_turn, segment_to_eye;

// Sets the gradients of the segment that integrate_segment() integrates next.
void set_lit_segment(vec3 front_gradient, vec3 back_gradient, vec3 to_eye) {
    segment_gradient = front_gradient;
    segment_turn = back_gradient - front_gradient;
    segment_to_eye = to_eye;
}

// Returns the contribution of light to the piece of the segment from share `from` of its length to share `to`.
// optics/analytic_segment.glsl calls it.
vec3 light_on_piece(float from, float to, vec2 depths, vec3 near, vec3 far, float in_front) {
    LitSegment segment = LitSegment(depths, segment_gradient + from * segment_turn, (to - from) * segment_turn,
                                    segment_to_eye);
    return light_added(light_along(segment, in_front), near, far);
}
#endif
#include "optics/analytic_segment.glsl"
vec4 tet_color() {
    FragmentSegment segment = find_segment();
#ifdef LIT
    set_lit_segment(segment.front_gradient, segment.back_gradient, segment.to_eye);
#endif
    return integrate_segment(segment.front, segment.back, segment.world_length);
}
#else
#error SOURCE is none of these
#endif
