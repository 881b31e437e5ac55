#version 450 core
// SPDX-License-Identifier: Apache-2.0
#ifdef FRAMEBUFFER_FETCH
#extension GL_EXT_shader_framebuffer_fetch : require
#endif
// Draws one slab: the part of the fragment's ray inside the slab and inside the box. Opacity comes
// from extinction and true length, never from an assumed step. BITS: opacity is rounded to a code
// here, by dithering or as render.emulate says. EMULATED: OVER is computed here, too, on codes.
// OPACITY_ONLY: opacity alone, for a leaf of a tree of fixed-point nodes.
#include "slicing/segment.glsl"
#ifdef BITS
#include "compositing/codes.glsl"
#endif
#ifdef DITHER_PERIOD
#include "compositing/dither.glsl"
flat in uvec2 ranks;
#endif
#ifdef EMULATED
#include "compositing/programmable_blending.glsl"
#else
layout(location = 0) out vec4 associated;
#endif
#if defined(ALPHA_ROUNDING) && ALPHA_ROUNDING == ROUND_STOCHASTIC
#include "compositing/random_bits.glsl"
uniform int image_rows;
uniform int seed;
#endif
#ifdef OPACITY_ONLY
uniform DEPTH depth_scale;  // samples of the ray over samples of the leaf (docs/numerics.md, section 3)
#endif

flat in float slab;

#ifdef BITS
uint alpha_code(double opacity) {
    double scaled = double(LARGEST_CODE) * opacity;
#ifdef DITHER_PERIOD
    return dither_code(scaled, ranks.x);
#else
    uint random = 0u;
#if ALPHA_ROUNDING == ROUND_STOCHASTIC
    random = random_bits(uint(gl_FragCoord.x), uint(image_rows) - 1u - uint(gl_FragCoord.y), uint(slab), uint(seed));
#endif
    return round_alpha(split_scaled(scaled), random);
#endif
}

uint color_code(float color) {
    double scaled = double(LARGEST_CODE) * double(clamp(color, 0.0, 1.0));
#ifdef DITHER_COLOR
    return dither_code(scaled, ranks.y);
#else
    return code_nearest(scaled);
#endif
}

uvec3 color_codes(vec3 color) { return uvec3(color_code(color.r), color_code(color.g), color_code(color.b)); }
#endif

void main() {
    Ray ray = view_ray(vec2(gl_FragCoord.x, 2.0 * image_middle.y - gl_FragCoord.y));
    REAL2 depths = clip_to_box(ray, slab_depths(slab, 1.0));
    if (!(depths.y > depths.x)) discard;
    Segment segment = integrate(ray, depths);
#ifdef OPACITY_ONLY
    segment.depth *= depth_scale;
#endif
    DEPTH opacity = opacity_from_depth(segment.depth);
#ifdef BITS
    uint alpha = alpha_code(opacity);
#endif
#if defined(EMULATED) && defined(OPACITY_ONLY)
    composite_opacity(alpha);
#elif defined(EMULATED)
    composite(color_codes(segment.color), alpha);
#elif defined(BITS)
    vec3 color = segment.color;
#ifdef DITHER_COLOR
    color = vec3(color_codes(color)) / float(LARGEST_CODE);
#endif
    float rounded = float(alpha) / float(LARGEST_CODE);
    associated = vec4(color * rounded, rounded);
#else
    associated = vec4(segment.color * opacity, opacity);
#endif
#if defined(OPACITY_ONLY) && !defined(EMULATED)
    associated.r = associated.a;
#endif
}
