// SPDX-License-Identifier: Apache-2.0
// Packs the colour of a node of a compositing tree, not associated, and the code of its optical
// depth. WIDE_CODE: the code has 16 bits, where colours have 8. MONOCHROME: the code alone is kept.
#include "compositing/packed_pixel.glsl"

#ifdef WIDE_CODE
uint packed_code(float code) { return code_of(code, 65535.0); }
float unpacked_code(uint word) { return float(word) / 65535.0; }
#else
uint packed_code(float code) { return to_word(code); }
float unpacked_code(uint word) { return from_word(word); }
#endif

#ifdef MONOCHROME
#define NODE_WORDS 1
uint[1] packed_node(vec3 color, float code) { return uint[](packed_code(code)); }
vec4 unpacked_node(uint words[1]) { return vec4(0.0, 0.0, 0.0, unpacked_code(words[0])); }
#elif defined(WIDE_CODE)
#define NODE_WORDS 2
uint[2] packed_node(vec3 color, float code) {
    return uint[](packed_pixel(vec4(color, 0.0))[0], packed_code(code));
}
vec4 unpacked_node(uint words[2]) {
    return vec4(unpacked_pixel(uint[](words[0])).rgb, unpacked_code(words[1]));
}
#else
#define NODE_WORDS PIXEL_WORDS
uint[NODE_WORDS] packed_node(vec3 color, float code) { return packed_pixel(vec4(color, code)); }
vec4 unpacked_node(uint words[NODE_WORDS]) { return unpacked_pixel(words); }
#endif
