#version 450 core
// SPDX-License-Identifier: Apache-2.0
// One slab of the slicing renderer: the part of the fragment's ray that lies inside the slab and inside the box, as
// associated colour and opacity. Opacity comes from extinction and true length, never from an assumed step.
#define SAMPLING_NONE 0
#define SAMPLING_FETCH 1
#define SAMPLING_FILTER 2

#include "slicing/ray.glsl"
#include "volume/scalar.glsl"
#include "optics/opacity.glsl"
#if SAMPLING == SAMPLING_NONE
uniform vec4 constant_optics;  // colour, extinction
#elif defined(PREINTEGRATED)
#include "optics/preintegration.glsl"
#else
#include "optics/transfer_function.glsl"
#endif
#ifdef SINGLE_COLOR
uniform vec3 single_color;
#endif

uniform vec3 box_min;  // the brick's part of the volume's box, index space
uniform vec3 box_max;

flat in vec2 slab;
layout(location = 0) out vec4 associated;

// Associated colour and optical depth (a) of the ray between two depths.
#if SAMPLING == SAMPLING_NONE
vec4 integrate(Ray ray, REAL2 depths, float world_length) {
    float depth = constant_optics.a * world_length;
    return vec4(constant_optics.rgb * opacity_from_depth(depth), depth);
}
#elif defined(PREINTEGRATED)
vec4 integrate(Ray ray, REAL2 depths, float world_length) {
    float front = sample_scalar(point_at(ray, depths.x));
    float middle = sample_scalar(point_at(ray, 0.5 * (depths.x + depths.y)));
    float back = sample_scalar(point_at(ray, depths.y));
#ifdef NAN_TRANSPARENT
    if (is_nan(front) || is_nan(middle) || is_nan(back)) discard;
#endif
    // What shows nothing between the least and the largest sample shows nothing: so empty space may be left out.
    float least = clamp(min(middle, min(front, back)), 0.0, 1.0);
    float largest = clamp(max(middle, max(front, back)), 0.0, 1.0);
    bool transparent = is_transparent(least, largest);
    // The table knows straight runs of the scalar; the trilinear field bends. The run from front to back is moved so
    // that its mean is that of the parabola through the three samples (Simpson's rule, exact for the cubic of one
    // cell): where extinction is linear in the scalar, optical depth is then right to fourth order instead of second.
    float bend = (2.0 / 3.0) * (middle - 0.5 * (front + back));
    return integrate_run(clamp(front + bend, 0.0, 1.0), clamp(back + bend, 0.0, 1.0), world_length,
                         transparent);
}
#else
vec4 integrate(Ray ray, REAL2 depths, float world_length) {
    float scalar = sample_scalar(point_at(ray, 0.5 * (depths.x + depths.y)));
#ifdef NAN_TRANSPARENT
    if (is_nan(scalar)) discard;
#endif
    vec4 optics = classify(clamp(scalar, 0.0, 1.0));
    float depth = optics.a * world_length;
    return vec4(optics.rgb * opacity_from_depth(depth), depth);
}
#endif

void main() {
    Ray ray = view_ray(gl_FragCoord.xy);
    REAL2 depths = clip_to_box(ray, slab, box_min, box_max);
    if (!(depths.y > depths.x)) discard;
    vec4 integral = integrate(ray, depths, float(depths.y - depths.x) * ray.length_per_depth);
    float opacity = opacity_from_depth(integral.a);
#ifdef SINGLE_COLOR
    integral.rgb = single_color * opacity;
#endif
    associated = vec4(integral.rgb, opacity);
}
