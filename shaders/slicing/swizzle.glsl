// SPDX-License-Identifier: Apache-2.0
// By code of a child's opacity, rows of 256: whole part and fraction of its opacity in the parent, times the largest
// code (LaMar 2004, section 6.2, "swizzle"): Phi becomes 1 - (1 - Phi)^share. Computed in double precision.
uniform sampler2D swizzle;

vec2 swizzled(int code) { return texelFetch(swizzle, ivec2(code & 255, code >> 8), 0).rg; }
