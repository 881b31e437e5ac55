// SPDX-License-Identifier: Apache-2.0
// For each brick of BRICK_EDGE^3 cells of the volume, the distance in bricks to the nearest visible
// one (facts/bricks.h).
uniform sampler3D distances;    // over 255
uniform vec3 first_sample;      // of the texture brick, in the volume
uniform vec3 last_distance;     // number of bricks minus one

// Returns 0 for bricks that may be visible.
int distance_to_shown(ivec3 brick) { return int(texelFetch(distances, brick, 0).r * 255.0 + 0.5); }
