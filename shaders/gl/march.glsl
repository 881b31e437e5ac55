// SPDX-License-Identifier: Apache-2.0
// Calls draw(), which stands in front of this file, for each pixel that is drawn. Each workgroup draws one tile or, if
// QUEUE is defined, takes tiles from a queue until none is left (slicing/gl_march.h). SORTED: tiles are drawn in the order
// of a list, and what each takes is noted for the next frame's list.
uniform int tile_columns;

#ifdef SORTED
layout(std430, binding = 5) readonly buffer Order { uint tile_order[]; };  // column and, 16 bits higher, row
layout(std430, binding = 6) buffer Costs { uint tile_costs[]; };           // by tile of the picture
uniform int cost_columns;

ivec2 tile_at(int place) { return ivec2(tile_order[place] & 0xffffu, tile_order[place] >> 16); }

// Draws a pixel, and notes the longest time that a pixel of its tile took, by the clock of the processor that it is on.
void draw_in(ivec2 tile, ivec2 pixel) {
    uint begin = clock2x32ARB().x;
    draw(pixel);
    uint taken = clock2x32ARB().x - begin;
    ivec2 place = (drawn_begin + tile_size * tile) / tile_size;
    atomicMax(tile_costs[place.y * cost_columns + place.x], taken);
}
#else
ivec2 tile_at(int place) { return ivec2(place % tile_columns, place / tile_columns); }
void draw_in(ivec2 tile, ivec2 pixel) { draw(pixel); }
#endif

#ifdef QUEUE
layout(std430, binding = 3) buffer Queue { uint next_tile; };
uniform int tile_count;
shared uint taken_tile;

void main() {
    while (true) {
        barrier();  // everyone has read which tile was taken before
        if (gl_LocalInvocationIndex == 0u) taken_tile = atomicAdd(next_tile, 1u);
        barrier();
        int place = int(taken_tile);
        if (place >= tile_count) return;
        ivec2 tile = tile_at(place);
        ivec2 pixel = pixel_of_tile(tile);
        if (is_drawn(pixel)) draw_in(tile, pixel);
    }
}
#else
void main() {
    ivec2 tile = tile_at(int(gl_WorkGroupID.y) * tile_columns + int(gl_WorkGroupID.x));
    ivec2 pixel = pixel_of_tile(tile);
    if (is_drawn(pixel)) draw_in(tile, pixel);
}
#endif
