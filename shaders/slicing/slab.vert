#version 450 core
// SPDX-License-Identifier: Apache-2.0
// A corner of a slab's polygon (slicing/slab_polygons.h).
layout(location = 0) in vec2 position;  // pixels from the image's left and top edge
layout(location = 1) in vec2 depths;    // of the slab: front, back

uniform vec2 image_size;

flat out vec2 slab;

void main() {
    slab = depths;
    vec2 device = 2.0 * position / image_size - 1.0;
    gl_Position = vec4(device.x, -device.y, 0.0, 1.0);
}
