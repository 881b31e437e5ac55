#version 450 core
// SPDX-License-Identifier: Apache-2.0
// Makes the image of a leaf whose slabs lie in several bricks from their sum in float
// (slicing/leaf.frag).
#include "slicing/node_output.glsl"

uniform sampler2D sum;  // associated colour, opacity
uniform int first_row;  // of the band of the image that is being drawn

void main() {
    vec4 associated_sum = texelFetch(sum, ivec2(gl_FragCoord.xy) - ivec2(0, first_row), 0);
    write_node(associated_sum.rgb, depth_from_opacity(min(associated_sum.a, 0.99999994)));
}
