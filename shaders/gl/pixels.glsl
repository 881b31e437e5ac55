// SPDX-License-Identifier: Apache-2.0
// Gives each invocation of a compute shader a pixel of a rectangle.
#ifdef SORTED
#extension GL_ARB_shader_clock : require  // of gl/march.glsl; extensions stand in front of all else
#endif
#include "gl/tile.glsl"

uniform ivec2 drawn_begin;  // column and row of the first pixel that is drawn; row 0 is at the top
uniform ivec2 drawn_end;    // behind the last one

// Returns the pixel of the invocation if its workgroup draws the tile in this column and row.
ivec2 pixel_of_tile(ivec2 tile) { return drawn_begin + tile_size * tile + pixel_in_tile(); }

ivec2 pixel_of_invocation() { return pixel_of_tile(ivec2(gl_WorkGroupID.xy)); }

// Tells whether a pixel is drawn: tiles at the edges have some that are not.
bool is_drawn(ivec2 pixel) { return all(lessThan(pixel, drawn_end)); }
