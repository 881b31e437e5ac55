// SPDX-License-Identifier: Apache-2.0
// A ray that goes from cell to cell of the grid.
#include "slicing/ray.glsl"

// A place of a ray: in a cell, from 0 to 1 along each axis. A ray that enters a cell does so
// exactly on its face, and within a cell floats have all digits that are needed.
struct CellPlace {
    ivec3 cell;
    vec3 place;
};

struct CellRay {
    vec3 slope;      // cells per depth
    vec3 inverse;
    bvec3 forward;   // towards larger indices
};

CellRay cell_ray(Ray ray) {
    vec3 slope = vec3(ray.direction);
    slope = mix(slope, vec3(1e-20), lessThan(abs(slope), vec3(1e-20)));
    return CellRay(slope, 1.0 / slope, greaterThan(slope, vec3(0.0)));
}

// Returns the place at a depth. On a plane between two cells a ray belongs to the cell that it enters.
CellPlace place_at(Ray ray, CellRay cells, REAL depth) {
    REAL3 there = ray.origin + depth * ray.direction;
    ivec3 cell = ivec3(mix(ceil(there) - REAL(1.0), floor(there), cells.forward));
    cell = clamp(cell, ivec3(floor(box_min)), ivec3(ceil(box_max)) - 1);
    return CellPlace(cell, clamp(vec3(there - REAL3(cell)), 0.0, 1.0));
}
