// SPDX-License-Identifier: Apache-2.0
// Writes the result of a node of a compositing tree whose nodes are computed in float
// (docs/numerics.md, section 4). ROOT: writes associated colour and opacity, the picture. Other
// nodes write colour that is not associated, and the code of the optical depth. MONOCHROME: they
// write the code alone. ALPHA_APART: the code goes to a texture of its own.
#include "compositing/node_code.glsl"

#ifdef ROOT
layout(location = 0) out vec4 associated;
#else
layout(location = 0) out vec4 image;
#ifdef ALPHA_APART
layout(location = 1) out vec4 alpha_image;
#endif
uniform float node_share;  // the node's share of the ray's samples
#endif
uniform float largest_color;  // the colour that images of nodes store as 1, because fixed point holds no more
#if defined(MONOCHROME) && !defined(SINGLE_COLOR)
uniform vec3 single_color;
#endif

// `color`: associated. `depth`: optical depth.
void write_node(vec3 color, float depth) {
    float opacity = opacity_from_depth(depth);
#ifdef MONOCHROME
    color = single_color * opacity;
#endif
#ifdef ROOT
    associated = vec4(color, opacity);
#else
    float code = encode_depth(depth, node_share);
#ifdef MONOCHROME
    image = vec4(code, 0.0, 0.0, 0.0);
#else
    image = vec4(opacity > 0.0 ? color / (opacity * largest_color) : vec3(0.0), code);
#ifdef ALPHA_APART
    alpha_image = vec4(code, 0.0, 0.0, 0.0);
#endif
#endif
#endif
}
