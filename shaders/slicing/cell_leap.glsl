// SPDX-License-Identifier: Apache-2.0
// Moves a ray over min/max bricks that show nothing, several in one step.
#include "slicing/brick_distances.glsl"
#include "slicing/cell_ray.glsl"

// Returns the number of the brick that holds a cell of the texture; beyond the volume, of the
// nearest brick.
ivec3 brick_of(ivec3 cell) {
    return clamp((cell + ivec3(first_sample)) / BRICK_EDGE, ivec3(0), ivec3(last_distance));
}

// Moves a ray to where it leaves the cube of bricks brick - reach + 1 .. brick + reach - 1, which
// show nothing, or to depth `end`, whichever comes first. `reach` is the distance of `brick`. A
// cube that reaches the volume's border is taken two bricks beyond it, because the volume's box may
// lie beyond its samples. `at`: the ray's place. `left`: the depth that remains to `end`.
void leap(Ray ray, CellRay cells, ivec3 brick, int reach, REAL end, inout CellPlace at, inout REAL left) {
    const int beyond = 2;
    ivec3 upper = brick + reach, lower = brick - reach + 1;
    upper += beyond * ivec3(greaterThan(upper, ivec3(last_distance)));
    lower -= beyond * ivec3(lessThan(lower, ivec3(1)));
    ivec3 plane = mix(lower, upper, cells.forward) * BRICK_EDGE - ivec3(first_sample);
    vec3 to_planes = (vec3(plane - at.cell) - at.place) * cells.inverse;
    float way = max(min(min(to_planes.x, to_planes.y), min(to_planes.z, float(left))), 0.0);
    left -= REAL(way);
    CellPlace there = place_at(ray, cells, end - left);
    bvec3 leaves = lessThanEqual(to_planes, vec3(way));
    at.cell = mix(there.cell, plane - 1 + ivec3(cells.forward), leaves);
    at.place = mix(there.place, vec3(not(cells.forward)), leaves);
}
