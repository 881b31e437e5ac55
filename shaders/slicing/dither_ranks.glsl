// SPDX-License-Identifier: Apache-2.0
uniform sampler2D dither_ranks;  // ranks of the slabs of a period, for alpha, then for colour; rows of 256

uint dither_rank(int place) { return uint(texelFetch(dither_ranks, ivec2(place & 255, place >> 8), 0).r); }

// Returns the ranks of a slab for alpha and for colour.
uvec2 ranks_of(int slab) {
    int place = slab % DITHER_PERIOD;
    return uvec2(dither_rank(place), dither_rank(DITHER_PERIOD + place));
}
