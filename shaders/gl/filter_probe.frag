// SPDX-License-Identifier: Apache-2.0
#version 450 core

// Filters a 4x4x4 texture linearly at positions that float32 represents exactly, so that every difference from the
// exact trilinear value is the filter's own. src/gl/framebuffer.cpp computes the same positions.
uniform sampler3D probe;
layout(location = 0) out vec4 filtered;

void main() {
    int index = int(gl_FragCoord.y) * 16 + int(gl_FragCoord.x);
    ivec3 step_4096 = (index * ivec3(467, 1283, 2741)) % 12288;
    vec3 position_texel = 0.5 + vec3(step_4096) / 4096.0;
    filtered = vec4(texture(probe, position_texel / 4.0).r);
}
