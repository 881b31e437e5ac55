#version 450 core
// SPDX-License-Identifier: Apache-2.0
// Makes the picture from the opacity in the root of a tree of fixed-point nodes, and a single
// colour.
uniform sampler2D root;
uniform vec3 single_color;
layout(location = 0) out vec4 associated;

void main() {
    float opacity = texelFetch(root, ivec2(gl_FragCoord.xy), 0).r;
    associated = vec4(single_color * opacity, opacity);
}
