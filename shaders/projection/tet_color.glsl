// SPDX-License-Identifier: Apache-2.0
// Associated colour and opacity of a fragment's part of its tet.
#include "optics/opacity.glsl"

#if SOURCE == SOURCE_CONSTANT
vec4 tet_color() {
    float opacity = opacity_from_depth(constant_optics.a * find_run().world_length);
    return vec4(constant_optics.rgb * opacity, opacity);
}
#elif SOURCE == SOURCE_PARTS
#include "optics/linear_segment.glsl"
vec4 tet_color() {
    TetRun run = find_run();
    OPTICS front = low_optics + run.front * (high_optics - low_optics);
    OPTICS back = low_optics + run.back * (high_optics - low_optics);
    return integrate_linear(front, back, run.world_length);
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
#include "optics/preintegration.glsl"
#ifndef TABLE_COLORED
uniform vec3 single_color;
#endif
vec4 tet_color() {
    TetRun run = find_run();
    float front = clamp(run.front, 0.0, 1.0), back = clamp(run.back, 0.0, 1.0);
    vec4 sum = integrate_run(front, back, run.world_length, is_transparent(min(front, back), max(front, back))).whole;
    float opacity = opacity_from_depth(sum.a);
#ifdef TABLE_COLORED
    return vec4(sum.rgb, opacity);
#else
    return vec4(single_color * opacity, opacity);
#endif
}
#elif SOURCE == SOURCE_TABLE || SOURCE == SOURCE_ANALYTIC
#if SOURCE == SOURCE_TABLE
#include "optics/segment_table.glsl"
#else
#include "optics/analytic_segment.glsl"
#endif
vec4 tet_color() {
    TetRun run = find_run();
    return integrate_segment(clamp(run.front, 0.0, 1.0), clamp(run.back, 0.0, 1.0), run.world_length);
}
#else
#error SOURCE is none of these
#endif
