// SPDX-License-Identifier: Apache-2.0
// Reads the gradients at the samples of the texture, along the grid's axes
// (slicing/gradient_map.h), as 16-bit components with a common exponent. Gradients that are read
// together are converted to a common unit, 2^(largest - unit_octaves), where `largest` is their
// largest exponent. So the squares of the largest, and of gradients 1e31 times as small, can be
// held in float32.
uniform isampler3D gradients;
uniform float smallest_gradient;  // 1 to 2; times 2^smallest_exponent
uniform int smallest_exponent;
uniform vec3 spacing;             // of samples, in the unit of lengths along rays
const int unit_octaves = 32;

// Returns 2^exponent, or 0 if that is too small.
float power_of_two(int exponent) { return intBitsToFloat(max(exponent + 127, 0) << 23); }

// Returns the components (xyz) and their common exponent (w) at a sample.
ivec4 stored_gradient(ivec3 sample_index) { return texelFetch(gradients, sample_index, 0); }

// Returns a gradient in the unit of gradients with this largest exponent.
vec3 gradient_in_unit(ivec4 stored, int largest) {
    return vec3(stored.xyz) * power_of_two(stored.w - largest + unit_octaves);
}

// Returns the square of the smallest gradient that is lit (Lighting::smallest_gradient) in that
// unit, limited to numbers that float32 can square: beyond these, everything or nothing is lit.
float smallest_square_in_unit(int largest) {
    const int most = 62;
    float smallest = smallest_gradient * power_of_two(clamp(smallest_exponent + unit_octaves - largest, -most, most));
    return smallest * smallest;
}

int largest_exponent(ivec4 a, ivec4 b, ivec4 c, ivec4 d) { return max(max(a.w, b.w), max(c.w, d.w)); }

// The gradients at the corners of a cell in their common unit, at its lower and its upper x. The
// order in each array is (y, z), (y + 1, z), (y, z + 1), (y + 1, z + 1).
struct CornerGradients {
    vec3 lower_x[4], upper_x[4];
    int largest;  // exponent
};

CornerGradients corner_gradients(ivec3 lower, ivec3 upper) {
    ivec4 stored[8] = ivec4[8](
        stored_gradient(lower), stored_gradient(ivec3(lower.x, upper.y, lower.z)),
        stored_gradient(ivec3(lower.xy, upper.z)), stored_gradient(ivec3(lower.x, upper.yz)),
        stored_gradient(ivec3(upper.x, lower.yz)), stored_gradient(ivec3(upper.xy, lower.z)),
        stored_gradient(ivec3(upper.x, lower.y, upper.z)), stored_gradient(upper));
    int largest = max(largest_exponent(stored[0], stored[1], stored[2], stored[3]),
                      largest_exponent(stored[4], stored[5], stored[6], stored[7]));
    vec3 lower_x[4] = vec3[4](gradient_in_unit(stored[0], largest), gradient_in_unit(stored[1], largest),
                              gradient_in_unit(stored[2], largest), gradient_in_unit(stored[3], largest));
    vec3 upper_x[4] = vec3[4](gradient_in_unit(stored[4], largest), gradient_in_unit(stored[5], largest),
                              gradient_in_unit(stored[6], largest), gradient_in_unit(stored[7], largest));
    return CornerGradients(lower_x, upper_x, largest);
}
