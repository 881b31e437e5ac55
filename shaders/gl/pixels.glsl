// SPDX-License-Identifier: Apache-2.0
// Gives each invocation of a compute shader a pixel of a rectangle.
#include "gl/tile.glsl"

uniform ivec2 drawn_begin;  // column and row of the first pixel that is drawn; row 0 is at the top
uniform ivec2 drawn_end;    // behind the last one

ivec2 pixel_of_invocation() {
    return drawn_begin + 8 * ivec2(gl_WorkGroupID.xy) + pixel_in_tile();
}

// Tells whether a pixel is drawn: tiles at the edges have some that are not.
bool is_drawn(ivec2 pixel) { return all(lessThan(pixel, drawn_end)); }
