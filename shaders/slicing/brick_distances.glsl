// SPDX-License-Identifier: Apache-2.0
// Distances of the volume's min/max bricks, of BRICK_EDGE^3 cells each, to the nearest visible one,
// in bricks along the axis on which the two are farthest apart (OccupiedBricks in facts/bricks.h).
uniform sampler3D distances;    // divided by 255
uniform vec3 first_sample;      // the volume's sample at which the texture begins
uniform vec3 last_distance;     // number of min/max bricks along each axis, minus one

// Returns a brick's distance; 0 if it may be visible itself.
int distance_to_shown(ivec3 brick) { return int(texelFetch(distances, brick, 0).r * 255.0 + 0.5); }
