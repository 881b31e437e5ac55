#version 450 core
// SPDX-License-Identifier: Apache-2.0
// Makes the picture from the opacity in the root of a tree of fixed-point nodes, and a single
// colour. EMULATED: both are codes.
#ifdef EMULATED
#include "compositing/over.glsl"
#define STORED (BITS > 8 ? 65535.0 : 255.0)
#endif

uniform sampler2D root;
uniform vec3 single_color;
layout(location = 0) out vec4 associated;

void main() {
    float opacity = texelFetch(root, ivec2(gl_FragCoord.xy), 0).r;
#ifdef EMULATED
    uint alpha = uint(opacity * STORED + 0.5);
    for (int channel = 0; channel < 3; ++channel) {
        uint color = code_nearest(double(LARGEST_CODE) * double(clamp(single_color[channel], 0.0, 1.0)));
        associated[channel] = float(divide_nearest(color * alpha)) / STORED;
    }
    associated.a = opacity;
#else
    associated = vec4(single_color * opacity, opacity);
#endif
}
