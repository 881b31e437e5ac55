#version 450 core
// SPDX-License-Identifier: Apache-2.0
// A corner of the polygon around a tet, or around the region of one on which the transfer function is linear (CUT).
// Every corner of a polygon refers to one record: TetRecord, or with CUT FragmentRecord (projection/tet_record.h).
layout(location = 0) in vec2 position;  // window coordinates
layout(location = 1) in uint record;

layout(std430, binding = 0) readonly buffer Records { uvec4 records[]; };
const uint record_size = 12u;
#ifdef LIT
layout(std430, binding = 1) readonly buffer GradientRecords { vec4 gradient_records[]; };
const uint gradient_record_size = 3u;
#endif

uniform vec2 image_size;

// The planes of four faces: depth at the center, and its change per column and per row. CAREFUL: doubles, each as the
// sum of two floats, high and low.
#ifdef CAREFUL
#define PAIR 2u
#else
#define PAIR 1u
#endif
flat out vec4 face_depths[3u * PAIR];
flat out vec4 center;           // column, row, depth, z
#ifdef SCALARS
flat out vec4 scalars;          // at the center; change per z, per column, per row
#endif
#if defined(EXACT_SEGMENTS) && defined(SCALARS)
flat out vec4 scalars_low;      // remainders of these that float does not hold
#endif
flat out vec4 limits;  // least and largest scalar (CUT: upper cut per column and row); number of front faces and number
                       // for dithering, in the bits of integers
#ifdef CUT
flat out vec4 cuts;             // lower: depth, per column, per row; upper: depth
flat out OPTICS low_optics, high_optics;  // at least and largest scalar; a: extinction
#endif

#ifdef LIT
// For each component of the gradient: at the center, per z, per column, per row
// (projection/tet_record.h).
flat out vec4 gradients[3];
#endif

void main() {
    uint first = record * record_size;
    for (uint i = 0u; i < 3u * PAIR; ++i) face_depths[i] = uintBitsToFloat(records[first + i * 2u / PAIR]);
    center = uintBitsToFloat(records[first + 6u]);
#ifdef SCALARS
    scalars = uintBitsToFloat(records[first + 7u]);
#endif
#if defined(EXACT_SEGMENTS) && defined(SCALARS)
    scalars_low = uintBitsToFloat(records[first + 10u]);
#endif
    limits = uintBitsToFloat(records[first + 8u]);
#ifdef CUT
    cuts = uintBitsToFloat(records[first + 9u]);
#ifdef TABLE_COLORED
    low_optics = uintBitsToFloat(records[first + 10u]);
    high_optics = uintBitsToFloat(records[first + 11u]);
#else
    low_optics = uintBitsToFloat(records[first + 10u].a);
    high_optics = uintBitsToFloat(records[first + 11u].a);
#endif
#endif
#ifdef LIT
    for (uint i = 0u; i < 3u; ++i) gradients[i] = gradient_records[record * gradient_record_size + i];
#endif
    gl_Position = vec4(2.0 * position / image_size - 1.0, 0.0, 1.0);
}
