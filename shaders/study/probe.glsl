// SPDX-License-Identifier: Apache-2.0
// The kernel of the probe (tools/lamina/selftest/shader_probe.h), which a fragment and a compute
// shader include: one number for a pixel, from many rounds of one kind of work. KERNEL says which:
// cubics of cells whose corners are in registers, or the corners of the cells along a ray, fetched
// as texels of a 3D texture, by gathers of four from a 2D texture (there are none from 3D ones), or as
// bytes of a buffer's words.
// Every number is a small multiple of 2^-9, so sums are exact in any order and on any machine.
#define KERNEL_ARITHMETIC 0
#define KERNEL_TEXELS 1
#define KERNEL_GATHERS 2
#define KERNEL_WORDS 3
#include "slicing/cell_cubic.glsl"
uniform int rounds;

#if KERNEL == KERNEL_ARITHMETIC
// Returns the sum of the scalars at the ends of parts of rays in cells that change from round to
// round.
float probe(ivec2 pixel) {
    vec3 place = vec3(pixel & 3, (pixel.x ^ pixel.y) & 3) / 4.0;
    vec3 change = 0.5 * (1.0 - place);
    Corners corners = Corners(vec4((pixel.xyxy >> ivec4(0, 0, 2, 2)) & 15), vec4((pixel.yxyx >> ivec4(1, 1, 3, 3)) & 15));
    float sum = 0.0;
    for (int i = 0; i < rounds; ++i) {
        sum += dot(cubic_along(corners, 0.0, place, change), vec4(1.0));
        corners = Corners(15.0 - corners.upper, corners.lower.yzwx);
    }
    return sum;
}
#else
uniform ivec2 pixel_step;   // from one pixel to the next, in units of 2^-12 voxels

#if KERNEL == KERNEL_TEXELS
Corners corners_of(ivec3 cell) { return fetch_corners(cell); }
#elif KERNEL == KERNEL_GATHERS
uniform sampler2D slices;   // the volume's slices side by side, 16 in a row

// Gathers the texels at (x, y + 1), (x + 1, y + 1), (x + 1, y) and (x, y) of a slice.
vec4 gather_codes(ivec3 cell) {
    ivec2 size = ivec2(last_sample.xy) + 1;
    ivec2 corner = ivec2(cell.z & 15, cell.z >> 4) * size + cell.xy + 1;
    return round(textureGather(slices, vec2(corner) / vec2(size * 16)) * largest_code);
}

Corners corners_of(ivec3 cell) {
    vec4 front = gather_codes(cell), back = gather_codes(cell + ivec3(0, 0, 1));
    return Corners(vec4(front.wx, back.wx), vec4(front.zy, back.zy));
}
#else
layout(std430, binding = 0) readonly buffer Samples { uint words[]; };

vec4 codes_at(ivec4 index) {
    uvec4 found = uvec4(words[index.x >> 2], words[index.y >> 2], words[index.z >> 2], words[index.w >> 2]);
    return vec4((found >> uvec4((index & 3) * 8)) & 255u);
}

Corners corners_of(ivec3 cell) {
    ivec3 size = ivec3(last_sample) + 1;
    int first = (cell.z * size.y + cell.y) * size.x + cell.x;
    ivec4 lower = first + ivec4(0, size.x, size.x * size.y, size.x * size.y + size.x);
    return Corners(codes_at(lower), codes_at(lower + 1));
}
#endif

// Returns the sum of the codes at the corners of the cells along a pixel's ray, one cell a round.
float probe(ivec2 pixel) {
    ivec3 start = ivec3(pixel * pixel_step, 0);
    float sum = 0.0;
    for (int i = 0; i < rounds; ++i) {
        Corners corners = corners_of((start + i * ivec3(704, 448, 4080)) >> 12);
        sum += dot(corners.lower + corners.upper, vec4(1.0));
    }
    return sum;
}
#endif
