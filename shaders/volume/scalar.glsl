// SPDX-License-Identifier: Apache-2.0
// Computes the scalar at a point of the texture's index space, normalised so that the volume's
// range is [0, 1].
#if SAMPLING != SAMPLING_NONE
uniform sampler3D volume;
uniform vec3 last_sample;     // the texture's size in samples, minus one
uniform vec2 normalisation;   // scale and offset from texel to normalised scalar

#if SAMPLING == SAMPLING_FETCH
float fetch_scalar(ivec3 index) { return texelFetch(volume, index, 0).r; }

// Interpolates trilinearly in float32, because the texture units of GPUs have 8-bit weights
// (docs/numerics.md, section 2).
float raw_scalar(vec3 point) {
    ivec3 lower = ivec3(min(point, max(last_sample - 1.0, 0.0)));
    ivec3 upper = min(lower + 1, ivec3(last_sample));
    vec3 share = point - vec3(lower);
    vec4 at_lower_x = vec4(fetch_scalar(lower), fetch_scalar(ivec3(lower.x, upper.y, lower.z)),
                           fetch_scalar(ivec3(lower.xy, upper.z)), fetch_scalar(ivec3(lower.x, upper.yz)));
    vec4 at_upper_x = vec4(fetch_scalar(ivec3(upper.x, lower.yz)), fetch_scalar(ivec3(upper.xy, lower.z)),
                           fetch_scalar(ivec3(upper.x, lower.y, upper.z)), fetch_scalar(upper));
    vec4 along_x = at_lower_x + share.x * (at_upper_x - at_lower_x);
    vec2 along_y = along_x.xz + share.y * (along_x.yw - along_x.xz);
    return along_y.x + share.z * (along_y.y - along_y.x);
}
#else
float raw_scalar(vec3 point) { return texture(volume, (point + 0.5) / (last_sample + 1.0)).r; }
#endif

// Tells whether a value is NaN: cells with a NaN sample are transparent, and interpolation keeps
// the NaN. It reads bits, because compilers may assume that comparisons meet no NaN.
bool is_nan(float value) { return (floatBitsToUint(value) & 0x7fffffffu) > 0x7f800000u; }

// Returns the normalised scalar. Beyond the samples (`cell` axes) the border value repeats.
float sample_scalar(vec3 point) {
    return raw_scalar(clamp(point, vec3(0.0), last_sample)) * normalisation.x + normalisation.y;
}
#endif
