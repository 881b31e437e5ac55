// SPDX-License-Identifier: Apache-2.0
// Packs the four codes of a pixel into words of a storage buffer, 8 or 16 bits each, and unpacks
// them (executors/gl_pixels.h). OPACITY_ONLY: keeps the first code alone.
#ifdef OPACITY_ONLY
#define CODE_WORDS 1
uint[1] packed_codes(uvec4 codes) { return uint[](codes.r); }
uvec4 unpacked_codes(uint words[1]) { return uvec4(words[0], 0u, 0u, 0u); }
#elif BITS > 8
#define CODE_WORDS 2
uint[2] packed_codes(uvec4 codes) { return uint[](codes.r | codes.g << 16, codes.b | codes.a << 16); }
uvec4 unpacked_codes(uint words[2]) {
    return uvec4(words[0] & 0xffffu, words[0] >> 16, words[1] & 0xffffu, words[1] >> 16);
}
#else
#define CODE_WORDS 1
uint[1] packed_codes(uvec4 codes) { return uint[](codes.r | codes.g << 8 | codes.b << 16 | codes.a << 24); }
uvec4 unpacked_codes(uint words[1]) {
    return uvec4(words[0] & 0xffu, words[0] >> 8 & 0xffu, words[0] >> 16 & 0xffu, words[0] >> 24);
}
#endif
