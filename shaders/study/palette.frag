#version 450 core
// SPDX-License-Identifier: Apache-2.0
// Draws a slice of 8-bit indices through a palette. The palette is uploaded for each slice or, with PALETTES, is one
// of that many rows of a texture.
uniform sampler2D indices;
uniform sampler2D palette;  // 256 entries a row
uniform int slice;

layout(location = 0) out vec4 associated;

void main() {
    ivec2 size = textureSize(indices, 0);
    ivec2 place = (ivec2(gl_FragCoord.xy) + ivec2(slice, 0)) % size;
    int index = int(texelFetch(indices, place, 0).r * 255.0 + 0.5);
#ifdef PALETTES
    associated = texelFetch(palette, ivec2(index, slice % PALETTES), 0);
#else
    associated = texelFetch(palette, ivec2(index, 0), 0);
#endif
}
