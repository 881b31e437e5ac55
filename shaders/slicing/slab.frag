#version 450 core
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

#if SAMPLING == SAMPLING_NONE
vec4 segment_optics(Ray ray, vec2 depths, float world_length) { return constant_optics; }
#elif defined(PREINTEGRATED)
vec4 segment_optics(Ray ray, vec2 depths, float world_length) {
    float front = sample_scalar(ray.origin + depths.x * ray.direction);
    float middle = sample_scalar(ray.origin + 0.5 * (depths.x + depths.y) * ray.direction);
    float back = sample_scalar(ray.origin + depths.y * ray.direction);
#ifdef NAN_TRANSPARENT
    if (is_nan(front) || is_nan(middle) || is_nan(back)) discard;
#endif
    // What shows nothing between the least and the largest sample shows nothing: so empty space may be left out.
    float least = clamp(min(middle, min(front, back)), 0.0, 1.0);
    float largest = clamp(max(middle, max(front, back)), 0.0, 1.0);
    if (mean_extinction(table_nodes(least, largest)) == 0.0) discard;
    // The table knows straight runs of the scalar; the trilinear field bends. The run from front to back is moved so
    // that its mean is that of the parabola through the three samples (Simpson's rule, exact for the cubic of one
    // cell): where extinction is linear in the scalar, optical depth is then right to fourth order instead of second.
    float bend = (2.0 / 3.0) * (middle - 0.5 * (front + back));
    vec4 entry = table_entry(
        table_nodes(clamp(front + bend, 0.0, 1.0), clamp(back + bend, 0.0, 1.0)), world_length);
#ifdef SINGLE_COLOR
    return entry;
#else
    return vec4(entry.a > 0.0 ? entry.rgb / entry.a : vec3(0.0), entry.a);
#endif
}
#else
vec4 segment_optics(Ray ray, vec2 depths, float world_length) {
    float scalar = sample_scalar(ray.origin + 0.5 * (depths.x + depths.y) * ray.direction);
#ifdef NAN_TRANSPARENT
    if (is_nan(scalar)) discard;
#endif
    return classify(clamp(scalar, 0.0, 1.0));
}
#endif

void main() {
    Ray ray = view_ray(gl_FragCoord.xy);
    vec2 depths = clip_to_box(ray, slab, box_min, box_max);
    if (!(depths.y > depths.x)) discard;
    float world_length = (depths.y - depths.x) * ray.length_per_depth;
    vec4 optics = segment_optics(ray, depths, world_length);
#ifdef SINGLE_COLOR
    optics.rgb = single_color;
#endif
    float opacity = opacity_from_depth(optics.a * world_length);
    associated = vec4(optics.rgb * opacity, opacity);
}
