// SPDX-License-Identifier: Apache-2.0
#include "compositing/over.glsl"

// Composites a fragment in the program instead of the blending unit: OVER on codes, which a target
// of 8 or 16 bits a channel holds as code / STORED. The program reads the pixel by framebuffer
// fetch, or as a texture with a barrier between slabs.
#define STORED (BITS > 8 ? 65535.0 : 255.0)

#ifdef FRAMEBUFFER_FETCH
layout(location = 0) inout vec4 pixel;
vec4 stored_pixel() { return pixel; }
#else
uniform sampler2D target;
layout(location = 0) out vec4 pixel;
vec4 stored_pixel() { return texelFetch(target, ivec2(gl_FragCoord.xy), 0); }
#endif

uvec4 stored_codes() { return uvec4(stored_pixel() * STORED + 0.5); }
void store_codes(uvec4 codes) { pixel = vec4(codes) / STORED; }

// Composites a colour, not associated.
void composite(uvec3 color, uint alpha) { store_codes(composited(color, alpha, stored_codes())); }

// Composites opacity alone, in the first channel.
void composite_opacity(uint alpha) {
    uint there = stored_codes().r;
#ifdef FRONT_TO_BACK
    store_codes(uvec4(under(LARGEST_CODE, alpha, there, there), 0u, 0u, 0u));
#else
    store_codes(uvec4(over(LARGEST_CODE, alpha, there), 0u, 0u, 0u));
#endif
}
