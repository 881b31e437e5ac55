// SPDX-License-Identifier: Apache-2.0
// Writes a fragment to the target; without these definitions the blending unit composites it. BITS: the target has
// codes, and opacity is rounded to a code here. DITHER_ALPHA: colour and opacity are rounded at random, before the
// blending unit. EMULATED: the fragment is composited here, as render.emulate says. AFTER_BLEND: it is composited here,
// and the result is rounded at random.
#if defined(BITS)
#include "compositing/codes.glsl"
#include "compositing/random_bits.glsl"
uniform int image_rows;
uniform int seed;
uint random_of_fragment() {
    uint row = uint(image_rows) - 1u - uint(gl_FragCoord.y);
    return random_bits(uint(gl_FragCoord.x), row, cell_fragment_number(), uint(seed));
}
#endif
#ifdef EMULATED
#include "compositing/programmable_blending.glsl"

uint alpha_code(float opacity) {
    double scaled = double(LARGEST_CODE) * double(opacity);
#if ALPHA_ROUNDING == ROUND_STOCHASTIC
    return round_alpha(split_scaled(scaled), random_of_fragment());
#else
    return round_alpha(split_scaled(scaled), 0u);
#endif
}

#ifdef OPACITY_ONLY
void write_fragment(vec4 color) { composite_opacity(alpha_code(color.a)); }
#else
void write_fragment(vec4 color) {
    vec3 separate = color.a > 0.0 ? clamp(color.rgb / color.a, 0.0, 1.0) : vec3(0.0);
    uvec3 codes;
    for (int channel = 0; channel < 3; ++channel)
        codes[channel] = code_nearest(double(LARGEST_CODE) * double(separate[channel]));
    composite(codes, alpha_code(color.a));
}
#endif
#elif defined(AFTER_BLEND)
#include "compositing/programmable_blending.glsl"
#include "compositing/stochastic_over.glsl"

void write_fragment(vec4 color) {
    uvec4 there = stored_codes();
    uint random = random_of_fragment();
    uvec4 result;
    for (int channel = 0; channel < 4; ++channel)
        result[channel] = over_stochastic(double(clamp(color[channel], 0.0, 1.0)), double(color.a), there[channel], random);
    store_codes(result);
}
#elif defined(DITHER_ALPHA)
layout(location = 0) out vec4 associated;

// Dithers as in Kraus 2004, section 4.2, but with one random number for opacity and colour, because the blending unit
// rounds associated colours, too.
void write_fragment(vec4 color) {
    float largest = float(LARGEST_CODE);
    vec4 scaled = clamp(color, 0.0, 1.0) * largest;
    vec4 whole = floor(scaled);
    float random = float(random_of_fragment() >> 8u) / 16777216.0;
    associated = (whole + vec4(lessThan(vec4(random), scaled - whole))) / largest;
}
#else
layout(location = 0) out vec4 associated;

void write_fragment(vec4 color) { associated = color; }
#endif
