// SPDX-License-Identifier: Apache-2.0
// Twin of compositing/codes.h: pcg4d of Jarzynski and Olano, "Hash Functions for GPU Rendering", JCGT 2020.
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
