#version 450 core
// SPDX-License-Identifier: Apache-2.0
// Composites the image of a fixed-point node onto its parent's buffer. The blending unit rounds.
#include "compositing/codes.glsl"
#include "slicing/swizzle.glsl"
layout(location = 0) out vec4 opacity;

uniform sampler2D child;

void main() {
    float largest = float(LARGEST_CODE);
    vec2 scaled = swizzled(int(texelFetch(child, ivec2(gl_FragCoord.xy), 0).r * largest + 0.5));
    opacity = vec4((scaled.x + scaled.y) / largest);
}
