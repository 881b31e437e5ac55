// SPDX-License-Identifier: Apache-2.0
// Computes the scalar along a part of a ray inside one cell of the grid, a cubic, normalised so
// that the volume's range is [0, 1].
// STEPS: the transfer function has steps. SAMPLE_WORDS: samples are words of a storage buffer, in place of texels.
#include "optics/cubic.glsl"
uniform vec3 last_sample;        // the brick's size in samples, minus one
uniform vec2 code_normalisation; // the code that becomes 0, and the factor to normalised scalars
uniform float largest_code;

#ifdef SAMPLE_WORDS
layout(std430, binding = 2) readonly buffer Samples { uint sample_words[]; };

// Returns a sample's code, a whole number. Float samples are stored normalised and returned as they
// are.
float fetch_code(ivec3 sample_index) {
    ivec2 size = ivec2(last_sample.xy) + 1;
    uint place = uint((sample_index.z * size.y + sample_index.y) * size.x + sample_index.x);
#ifdef FLOAT_SAMPLES
    return uintBitsToFloat(sample_words[place]);
#else
    // A word holds four codes of 8 bits or two of 16.
    uint shift = largest_code > 255.0 ? 1u : 2u;
    uint bits = 32u >> shift;
    uint in_word = place & (1u << shift) - 1u;
    return float(sample_words[place >> shift] >> in_word * bits & (1u << bits) - 1u);
#endif
}
#else
uniform sampler3D volume;

// Returns a sample's code, a whole number: a texel holds it divided by the largest code, with a
// rounding. Float samples are stored normalised and returned as they are.
float fetch_code(ivec3 sample_index) {
    float texel = texelFetch(volume, sample_index, 0).r;
#ifdef FLOAT_SAMPLES
    return texel;
#else
    return round(texel * largest_code);
#endif
}
#endif

// The codes at a cell's corners, at the lower and at the upper x. The components are those at (y,
// z), (y + 1, z), (y, z + 1) and (y + 1, z + 1).
struct Corners {
    vec4 lower, upper;
};

Corners fetch_corners(ivec3 cell) {
    ivec3 upper = min(cell + 1, ivec3(last_sample));
    return Corners(vec4(fetch_code(cell), fetch_code(ivec3(cell.x, upper.y, cell.z)),
                        fetch_code(ivec3(cell.xy, upper.z)), fetch_code(ivec3(cell.x, upper.yz))),
                   vec4(fetch_code(ivec3(upper.x, cell.yz)), fetch_code(ivec3(upper.xy, cell.z)),
                        fetch_code(ivec3(upper.x, cell.y, upper.z)), fetch_code(upper)));
}

// Returns the four coefficients in t, constant first, of the cell's trilinear field at place + t *
// change, minus `base`. They are computed from differences of corners, so that a constant cell
// gives an exact constant.
vec4 cubic_along(Corners corners, float base, vec3 place, vec3 change) {
    vec4 x = corners.upper - corners.lower;
    float y = corners.lower.y - corners.lower.x, z = corners.lower.z - corners.lower.x;
    float xy = x.y - x.x, xz = x.z - x.x, yz = (corners.lower.w - corners.lower.z) - y;
    float xyz = (x.w - x.z) - xy;
    // Mixed second derivatives (yz, xz, xy) at the entry.
    vec3 bend = vec3(yz, xz, xy) + place * xyz;
    vec3 slope = vec3(x.x + place.y * bend.z + place.z * xz, y + place.x * bend.z + place.z * yz,
                      z + place.x * bend.y + place.y * yz);
    return vec4((corners.lower.x - base) + place.x * (x.x + place.y * bend.z) + place.y * (y + place.z * yz) +
                    place.z * (z + place.x * xz),
                dot(change, slope),
                change.x * change.y * bend.z + change.z * (change.x * bend.y + change.y * bend.x),
                change.x * change.y * change.z * xyz);
}

bool is_nan(float value) { return (floatBitsToUint(value) & 0x7fffffffu) > 0x7f800000u; }

// Tells whether a corner is NaN. It reads bits, because compilers may assume that comparisons meet
// no NaN.
bool has_nan(Corners corners) {
    vec4 sums = corners.lower + corners.upper;
    return is_nan((sums.x + sums.y) + (sums.z + sums.w));
}

#ifdef NEAREST_LOOKUP
// Returns the normalised scalar in a voxel. Beyond the samples (`cell` axes) the border value
// repeats. `transparent`: true if NaN is transparent and it is the sample.
CellScalar cell_scalar(ivec3 voxel, vec3 place, vec3 change, out bool transparent) {
    float code = fetch_code(clamp(voxel, ivec3(0), ivec3(last_sample)));
#ifdef NAN_TRANSPARENT
    transparent = is_nan(code);
#else
    transparent = false;
#endif
    CellScalar scalar;
    scalar.cubic = vec4(transparent ? 0.0 : (code - code_normalisation.x) * code_normalisation.y, vec3(0.0));
#ifdef STEPS
    scalar.limits = scalar.cubic.xx;
#endif
    return scalar;
}
#else
// Returns the corners that a part of a ray sees. If it stays in a face on an axis, as it does beyond
// the samples of `cell` axes, those of the other face are replaced by this one's.
Corners seen_corners(Corners corners, vec3 place, vec3 change) {
    bvec3 stays = equal(change, vec3(0.0));
    if (stays.x && place.x <= 0.0) corners.upper = corners.lower;
    if (stays.x && place.x >= 1.0) corners.lower = corners.upper;
    if (stays.y && place.y <= 0.0) corners = Corners(corners.lower.xxzz, corners.upper.xxzz);
    if (stays.y && place.y >= 1.0) corners = Corners(corners.lower.yyww, corners.upper.yyww);
    if (stays.z && place.z <= 0.0) corners = Corners(corners.lower.xyxy, corners.upper.xyxy);
    if (stays.z && place.z >= 1.0) corners = Corners(corners.lower.zwzw, corners.upper.zwzw);
    return corners;
}

// Returns the scalars between the least and the largest of the corners. These two themselves are
// shown by constant fields alone; others meet them in a set of no volume. So they are left out, by a
// few roundings of a scalar in 0 .. 1: else a rounding would put a ray that only touches a step of
// the transfer function on its other side (docs/numerics.md, section 9.3).
vec2 limits_of(Corners corners) {
    vec4 least = min(corners.lower, corners.upper), largest = max(corners.lower, corners.upper);
    vec2 codes = vec2(min(min(least.x, least.y), min(least.z, least.w)),
                      max(max(largest.x, largest.y), max(largest.z, largest.w)));
    vec2 limits = (codes - code_normalisation.x) * code_normalisation.y;
    float margin = min(0.5 * (limits.y - limits.x), 1.1920929e-7);
    return vec2(limits.x + margin, limits.y - margin);
}

// Returns the normalised scalar along the part of a ray from `place`, counted from the cell's
// lowest corner, to place + change. Beyond the samples (`cell` axes) the border value repeats.
// `transparent`: true if NaN is transparent and a corner is NaN.
CellScalar cell_scalar(ivec3 cell, vec3 place, vec3 change, out bool transparent) {
    ivec3 last = ivec3(last_sample);
    ivec3 lowest = clamp(cell, ivec3(0), max(last - 1, 0));
    vec3 share = clamp(place + vec3(cell - lowest), vec3(0.0), min(last_sample, vec3(1.0)));
    Corners corners = fetch_corners(lowest);
    vec3 moved = change * vec3(equal(cell, lowest));
    CellScalar scalar;
    scalar.cubic = cubic_along(corners, code_normalisation.x, share, moved);
#ifdef NAN_TRANSPARENT
    transparent = has_nan(corners);
    if (transparent) scalar.cubic = vec4(0.0);
#else
    transparent = false;
#endif
    scalar.cubic *= code_normalisation.y;
#ifdef STEPS
    scalar.limits = transparent ? vec2(0.0) : limits_of(seen_corners(corners, share, moved));
#endif
    return scalar;
}
#endif
