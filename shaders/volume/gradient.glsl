// SPDX-License-Identifier: Apache-2.0
// The gradients at the samples of the brick, along the grid's axes (slicing/gradient_map.h). Some of them that are
// looked at together have the unit 2^(largest - unit_octaves), where `largest` is their largest exponent: so squares of
// the largest, and of those 1e31 times as small, are numbers in float32.
uniform isampler3D gradients;
uniform float smallest_gradient;  // times 2^smallest_exponent, 1 to 2
uniform int smallest_exponent;
uniform vec3 spacing;             // of samples, in the unit of lengths along rays
const int unit_octaves = 32;

// Returns 2^exponent, 0 where that is too small.
float power_of_two(int exponent) { return intBitsToFloat(max(exponent + 127, 0) << 23); }

// Returns the components, and the exponent that they have in common.
ivec4 stored_gradient(ivec3 sample_index) { return texelFetch(gradients, sample_index, 0); }

vec3 gradient_in_unit(ivec4 stored, int largest) {
    return vec3(stored.xyz) * power_of_two(stored.w - largest + unit_octaves);
}

// Returns the square of the smallest gradient in that unit, kept to what float32 can square: outside, all or nothing is
// lit.
float smallest_square_in_unit(int largest) {
    const int most = 62;
    float smallest = smallest_gradient * power_of_two(clamp(smallest_exponent + unit_octaves - largest, -most, most));
    return smallest * smallest;
}
