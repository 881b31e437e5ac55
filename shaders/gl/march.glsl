// SPDX-License-Identifier: Apache-2.0
// Calls draw(), which stands in front of this file, for each pixel that is drawn. Each workgroup draws one tile or, if
// QUEUE is defined, takes tiles from a queue until none is left (slicing/gl_march.h).
#ifdef QUEUE
layout(std430, binding = 3) buffer Queue { uint next_tile; };
uniform int tile_columns;
uniform int tile_count;
shared uint taken_tile;

void main() {
    while (true) {
        barrier();  // everyone has read which tile was taken before
        if (gl_LocalInvocationIndex == 0u) taken_tile = atomicAdd(next_tile, 1u);
        barrier();
        int tile = int(taken_tile);
        if (tile >= tile_count) return;
        ivec2 pixel = pixel_of_tile(ivec2(tile % tile_columns, tile / tile_columns));
        if (is_drawn(pixel)) draw(pixel);
    }
}
#else
void main() {
    ivec2 pixel = pixel_of_invocation();
    if (is_drawn(pixel)) draw(pixel);
}
#endif
