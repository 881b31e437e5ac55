// SPDX-License-Identifier: Apache-2.0
// Writes a fragment to the target, where the blending unit composites it. DITHER_ALPHA: colour and opacity are rounded
// to codes of BITS bits at random before.
layout(location = 0) out vec4 associated;

#ifdef DITHER_ALPHA
#include "compositing/codes.glsl"
#include "compositing/random_bits.glsl"
uniform int image_rows;
uniform int seed;

// Dithers as in Kraus 2004, section 4.2, but with one random number for opacity and colour, because the blending unit
// rounds associated colours, too.
void write_fragment(vec4 color) {
    float largest = float(LARGEST_CODE);
    vec4 scaled = clamp(color, 0.0, 1.0) * largest;
    vec4 whole = floor(scaled);
    uint row = uint(image_rows) - 1u - uint(gl_FragCoord.y);
    uint bits = random_bits(uint(gl_FragCoord.x), row, cell_fragment_number(), uint(seed));
    float random = float(bits >> 8u) / 16777216.0;
    associated = (whole + vec4(lessThan(vec4(random), scaled - whole))) / largest;
}
#else
void write_fragment(vec4 color) { associated = color; }
#endif
