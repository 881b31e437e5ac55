// SPDX-License-Identifier: Apache-2.0
// Returns 32 random bits for a pixel, a step of drawing (slab or node) and a seed: the hash pcg4d
// of Jarzynski and Olano, "Hash Functions for GPU Rendering", JCGT 2020. Twin of random_bits in
// compositing/codes.h.
uint random_bits(uint column, uint row, uint stage, uint seed) {
    uvec4 v = uvec4(column, row, stage, seed) * 1664525u + 1013904223u;
    for (int i = 0; i < 2; ++i) {
        v.x += v.y * v.w;
        v.y += v.z * v.x;
        v.z += v.x * v.y;
        v.w += v.y * v.z;
        if (i == 0) v ^= v >> 16u;
    }
    return v.w;
}
