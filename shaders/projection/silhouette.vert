#version 450 core
// SPDX-License-Identifier: Apache-2.0
// A corner of the polygon around a tet, or around the region of one on which the transfer function is linear (CUT).
// Every corner of a polygon refers to one record.
#define SEEN flat out
#define READS_RECORDS
#include "projection/silhouette_record.glsl"

layout(location = 0) in vec2 position;  // window coordinates
layout(location = 1) in uint record;

uniform vec2 image_size;

void main() {
    read_record(record);
    gl_Position = vec4(2.0 * position / image_size - 1.0, 0.0, 1.0);
}
