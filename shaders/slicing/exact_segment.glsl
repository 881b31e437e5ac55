// SPDX-License-Identifier: Apache-2.0
// Integrates a ray between two depths cell by cell through the trilinear field (docs/numerics.md,
// section 9). The result is exact except for rounding and for Gauss' rules, so it does not depend
// on how the ray is divided into segments. OCCUPIED_ONLY: leaps over empty space. ENDS_EARLY: ends
// the ray once nothing behind is visible.
#include "slicing/cell_cubic.glsl"
#include "slicing/cell_ray.glsl"
#include "slicing/cut_cell.glsl"
#ifdef OCCUPIED_ONLY
#include "slicing/cell_leap.glsl"
#endif
#ifdef ENDS_EARLY
uniform float opaque_depth;
#endif

// Adds the part of a ray between two depths to what the ray has passed.
void integrate_cells(Ray ray, REAL2 depths, inout RaySum sum) {
    CellRay cells = cell_ray(ray);
    CellPlace at = place_at(ray, cells, depths.x);
    REAL left = depths.y - depths.x;
#ifdef LIGHTS
    vec3 to_eye = -normalize(vec3(ray.direction) * spacing);
#endif
    while (left > REAL(0.0)) {
#ifdef OCCUPIED_ONLY
        ivec3 brick = brick_of(at.cell);
        int reach = distance_to_shown(brick);
        while (reach > 0 && left > REAL(0.0)) {
            leap(ray, cells, brick, reach, depths.y, at, left);
            brick = brick_of(at.cell);
            reach = distance_to_shown(brick);
        }
        if (!(left > REAL(0.0))) break;
#endif
        vec3 to_faces = (vec3(cells.forward) - at.place) * cells.inverse;
        float way = min(min(to_faces.x, to_faces.y), min(to_faces.z, float(left)));
        vec3 change = way * cells.slope;
        // Roundings may leave a rest of the way behind the box's last cell.
        ivec3 cell = nearest_cell(at.cell);
        bool transparent;
        CellScalar scalar = cell_scalar(cell, at.place + vec3(at.cell - cell), change, transparent);
        float world_length = transparent ? 0.0 : way * float(ray.length_per_depth);
#ifdef LIGHTS
        add_part(scalar, world_length, LitStep(at.cell, at.place, change, to_eye), sum);
#else
        add_part(scalar, world_length, sum);
#endif
#ifdef ENDS_EARLY
        if (sum.depth >= opaque_depth) break;
#endif
        bvec3 leaves = lessThanEqual(to_faces, vec3(way));
        at.place = mix(clamp(at.place + change, 0.0, 1.0), vec3(not(cells.forward)), leaves);
        at.cell += ivec3(leaves) * (2 * ivec3(cells.forward) - 1);
        left -= REAL(way);
    }
}
