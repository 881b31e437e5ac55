#version 450 core
// SPDX-License-Identifier: Apache-2.0
// A vertex of the triangles of Kraus 2004: FanVertex (projection/fan_geometry.h). w = 1, so that values are
// interpolated linearly in the picture (Kraus 2004, section 2.3).
layout(location = 0) in vec2 position;  // window coordinates
layout(location = 1) in vec3 inverse_in;
layout(location = 2) in vec4 front_in;
layout(location = 3) in vec4 back_in;
layout(location = 4) in vec2 scalars_in;
layout(location = 5) in uint tet_in;

uniform vec2 image_size;

out vec3 inverse;
out vec4 front_values;
out vec4 back_values;
flat out vec2 scalars;
flat out uint tet;

void main() {
    inverse = inverse_in;
    front_values = front_in;
    back_values = back_in;
    scalars = scalars_in;
    tet = tet_in;
    gl_Position = vec4(2.0 * position / image_size - 1.0, 0.0, 1.0);
}
