#version 450 core
// SPDX-License-Identifier: Apache-2.0
#ifdef FRAMEBUFFER_FETCH
#extension GL_EXT_shader_framebuffer_fetch : require
#endif
// Composites the image of a fixed-point node onto its parent's buffer (LaMar 2004, section 6.2,
// "swizzle"): each opacity Phi becomes 1 - (1 - Phi)^share, looked up in a table that was computed
// in double precision.
#include "compositing/codes.glsl"
#ifdef EMULATED
#include "compositing/programmable_blending.glsl"
#else
layout(location = 0) out vec4 opacity;
#define STORED float(LARGEST_CODE)
#endif
#if ALPHA_ROUNDING == ROUND_STOCHASTIC
#include "compositing/random_bits.glsl"
uniform int image_rows;
uniform int seed;
uniform int stage;
#endif

uniform sampler2D child;
uniform sampler2D swizzle;  // by code, rows of 256: whole part and fraction of the parent's opacity * largest code

void main() {
    int code = int(texelFetch(child, ivec2(gl_FragCoord.xy), 0).r * STORED + 0.5);
    vec2 scaled = texelFetch(swizzle, ivec2(code & 255, code >> 8), 0).rg;
#ifdef EMULATED
    uint random = 0u;
#if ALPHA_ROUNDING == ROUND_STOCHASTIC
    random = random_bits(uint(gl_FragCoord.x), uint(image_rows) - 1u - uint(gl_FragCoord.y), uint(stage), uint(seed));
#endif
    composite_opacity(round_alpha(ScaledValue(uint(scaled.x), double(scaled.y)), random));
#else
    opacity = vec4((scaled.x + scaled.y) / STORED);
#endif
}
