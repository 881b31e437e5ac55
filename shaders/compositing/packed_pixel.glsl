// SPDX-License-Identifier: Apache-2.0
// Packs the four numbers of a pixel into words of a storage buffer (executors/gl_pixels.h), and
// unpacks them. PACKING says how: as floats, halves, or codes of 16 or 8 bits. Shaders round, and
// not the driver, because OpenGL leaves the rounding of stores to images to the driver.
#define PACKING_FLOATS 0
#define PACKING_HALVES 1
#define PACKING_SHORTS 2
#define PACKING_BYTES 3

uint code_of(float value, float largest) { return uint(roundEven(clamp(value, 0.0, 1.0) * largest)); }

#if PACKING == PACKING_FLOATS
#define PIXEL_WORDS 4
uint to_word(float value) { return floatBitsToUint(value); }
float from_word(uint word) { return uintBitsToFloat(word); }
uint[4] packed_pixel(vec4 value) {
    return uint[](to_word(value.r), to_word(value.g), to_word(value.b), to_word(value.a));
}
vec4 unpacked_pixel(uint words[4]) {
    return vec4(from_word(words[0]), from_word(words[1]), from_word(words[2]), from_word(words[3]));
}
#elif PACKING == PACKING_BYTES
#define PIXEL_WORDS 1
uint to_word(float value) { return code_of(value, 255.0); }
float from_word(uint word) { return float(word & 0xffu) / 255.0; }
uint[1] packed_pixel(vec4 value) {
    return uint[](to_word(value.r) | to_word(value.g) << 8 | to_word(value.b) << 16 | to_word(value.a) << 24);
}
vec4 unpacked_pixel(uint words[1]) {
    uint word = words[0];
    return vec4(from_word(word), from_word(word >> 8), from_word(word >> 16), from_word(word >> 24));
}
#else
#define PIXEL_WORDS 2
#if PACKING == PACKING_SHORTS
uint to_word(float value) { return code_of(value, 65535.0); }
float from_word(uint word) { return float(word & 0xffffu) / 65535.0; }
#elif PACKING == PACKING_HALVES
// Returns the half next to the value on the side of 0, as the cpu engine and llvmpipe store halves.
// Below 2^-14 their spacing is 2^-24. The largest is 65504.
uint to_word(float value) {
    float small = trunc(value * 16777216.0) / 16777216.0;
    float normal = uintBitsToFloat(floatBitsToUint(value) & ~0x1fffu);
    return packHalf2x16(vec2(min(abs(value) < 6.1035156e-5 ? small : normal, 65504.0), 0.0));
}
float from_word(uint word) { return unpackHalf2x16(word & 0xffffu).x; }
#else
#error PACKING is none of these
#endif
uint[2] packed_pixel(vec4 value) {
    return uint[](to_word(value.r) | to_word(value.g) << 16, to_word(value.b) | to_word(value.a) << 16);
}
vec4 unpacked_pixel(uint words[2]) {
    return vec4(from_word(words[0]), from_word(words[0] >> 16), from_word(words[1]), from_word(words[1] >> 16));
}
#endif
