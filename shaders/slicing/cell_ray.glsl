// SPDX-License-Identifier: Apache-2.0
// A ray that goes from cell to cell of the grid.
#include "slicing/ray.glsl"

// A point of a ray: its cell, and the place in it from 0 to 1 along each axis. A ray enters a cell
// exactly on its face, and floats hold enough digits of a place in one cell.
struct CellPlace {
    ivec3 cell;
    vec3 place;
};

struct CellRay {
    vec3 slope;      // change of place with depth, never 0
    vec3 inverse;
    bvec3 forward;   // towards larger indices
};

CellRay cell_ray(Ray ray) {
    vec3 slope = vec3(ray.direction);
    slope = mix(slope, vec3(1e-20), lessThan(abs(slope), vec3(1e-20)));
    return CellRay(slope, 1.0 / slope, greaterThan(slope, vec3(0.0)));
}

// Returns the cell of the box that is the nearest.
ivec3 nearest_cell(ivec3 cell) {
    return clamp(cell, ivec3(floor(box_min)), ivec3(ceil(box_max)) - 1);
}

// Returns the place at a depth. A ray on a plane between two cells is in the one that it enters.
CellPlace place_at(Ray ray, CellRay cells, REAL depth) {
    REAL3 there = ray.origin + depth * ray.direction;
    ivec3 cell = nearest_cell(ivec3(mix(ceil(there) - REAL(1.0), floor(there), cells.forward)));
    return CellPlace(cell, clamp(vec3(there - REAL3(cell)), 0.0, 1.0));
}
