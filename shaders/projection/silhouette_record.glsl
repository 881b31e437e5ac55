// SPDX-License-Identifier: Apache-2.0
// The record of a tet, or of the region of one on which the transfer function is linear (CUT): TetRecord or
// FragmentRecord (projection/tet_record.h). SEEN: the storage of its members: inputs or outputs of a stage, or nothing
// for variables. READS_RECORDS: this stage reads records from a storage block; READS_TEXELS: from a buffer of texels,
// which takes llvmpipe a fraction of the time.

// The planes of four faces: depth at the center, and its change per column and per row. CAREFUL: doubles, each as the
// sum of two floats, high and low.
#ifdef CAREFUL
#define PAIR 2u
#else
#define PAIR 1u
#endif
SEEN vec4 face_depths[3u * PAIR];
SEEN vec4 center;           // column, row, depth, z
#ifdef SCALARS
SEEN vec4 scalars;          // at the center; change per z, per column, per row
#endif
#if defined(EXACT_SEGMENTS) && defined(SCALARS)
SEEN vec4 scalars_low;      // remainders of these that float does not hold
#endif
SEEN vec4 limits;  // least and largest scalar (CUT: upper cut per column and row); number of front faces and number
                   // for dithering, in the bits of integers
#ifdef CUT
SEEN vec4 cuts;             // lower: depth, per column, per row; upper: depth
SEEN OPTICS low_optics, high_optics;  // at least and largest scalar; a: extinction
#endif
#ifdef LIT
// For each component of the gradient: at the center, per z, per column, per row
// (projection/tet_record.h).
SEEN vec4 gradients[3];
#endif

#if defined(READS_RECORDS) || defined(READS_TEXELS)
const uint record_size = 12u;
#ifdef LIT
const uint gradient_record_size = 3u;
#endif
#ifdef READS_TEXELS
uniform usamplerBuffer records;
vec4 record_part(uint place) { return uintBitsToFloat(texelFetch(records, int(place))); }
#ifdef LIT
uniform usamplerBuffer gradient_records;
vec4 gradient_part(uint place) { return uintBitsToFloat(texelFetch(gradient_records, int(place))); }
#endif
#else
layout(std430, binding = 0) readonly buffer Records { uvec4 records[]; };
vec4 record_part(uint place) { return uintBitsToFloat(records[place]); }
#ifdef LIT
layout(std430, binding = 1) readonly buffer GradientRecords { vec4 gradient_records[]; };
vec4 gradient_part(uint place) { return gradient_records[place]; }
#endif
#endif

void read_record(uint record) {
    uint first = record * record_size;
    for (uint i = 0u; i < 3u * PAIR; ++i) face_depths[i] = record_part(first + i * 2u / PAIR);
    center = record_part(first + 6u);
#ifdef SCALARS
    scalars = record_part(first + 7u);
#endif
#if defined(EXACT_SEGMENTS) && defined(SCALARS)
    scalars_low = record_part(first + 10u);
#endif
    limits = record_part(first + 8u);
#ifdef CUT
    cuts = record_part(first + 9u);
#ifdef TABLE_COLORED
    low_optics = record_part(first + 10u);
    high_optics = record_part(first + 11u);
#else
    low_optics = record_part(first + 10u).a;
    high_optics = record_part(first + 11u).a;
#endif
#endif
#ifdef LIT
    for (uint i = 0u; i < 3u; ++i) gradients[i] = gradient_part(record * gradient_record_size + i);
#endif
}
#endif
