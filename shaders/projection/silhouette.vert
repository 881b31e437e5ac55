#version 450 core
// SPDX-License-Identifier: Apache-2.0
// A corner of the polygon around a tet; all of them carry the tet's record (projection/tet_record.h).
layout(location = 0) in vec2 position;  // window coordinates
layout(location = 1) in uint record;

layout(std430, binding = 0) readonly buffer Records { uvec4 records[]; };
const uint record_size = 9u;

uniform vec2 image_size;

// Of four faces: depth, per column, per row; with CAREFUL, high and low parts of each.
#ifdef CAREFUL
#define PARTS 2u
#else
#define PARTS 1u
#endif
flat out vec4 face_depths[3u * PARTS];
flat out vec4 center;           // column, row, depth, z
#ifdef SCALARS
flat out vec4 scalars;          // at the center, per z, per column, per row
#endif
flat out vec4 limits;           // least and largest scalar, bits of the number of front faces and of the tet

void main() {
    uint first = record * record_size;
    for (uint i = 0u; i < 3u * PARTS; ++i) face_depths[i] = uintBitsToFloat(records[first + i * 2u / PARTS]);
    center = uintBitsToFloat(records[first + 6u]);
#ifdef SCALARS
    scalars = uintBitsToFloat(records[first + 7u]);
#endif
    limits = uintBitsToFloat(records[first + 8u]);
    gl_Position = vec4(2.0 * position / image_size - 1.0, 0.0, 1.0);
}
