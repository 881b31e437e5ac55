// SPDX-License-Identifier: Apache-2.0
// Integrates a ray between two depths cell by cell through the trilinear field (docs/numerics.md,
// section 9). The result is exact except for rounding and for Gauss' rules, so it does not depend
// on how the ray is divided into segments. OCCUPIED_ONLY: leaps over empty space. ENDS_EARLY: ends
// the ray once nothing behind is visible.
//
// A GPU and llvmpipe draw a group of 8 to 64 rays in step: all wait while one of them cuts a cell,
// which takes several times as long as a cell that is not cut. So a cell waits to be cut, and what
// lies behind it is added up apart, until a ray of the group finds a second one. Then all that wait
// are cut at once. What a ray adds up does not depend on when that is. CUTS_ALONE: cells are cut at
// once.
#include "slicing/cell_cubic.glsl"
#include "slicing/cell_ray.glsl"
#include "slicing/cut_cell.glsl"
#ifdef OCCUPIED_ONLY
#include "slicing/cell_leap.glsl"
#endif
#ifdef ENDS_EARLY
uniform float opaque_depth;
#endif

// Tells whether a condition holds for a ray of the group. On drivers that cannot tell, each ray
// cuts its own cells.
#ifdef GL_ARB_shader_group_vote
#define any_of_group(condition) anyInvocationARB(condition)
#else
#define any_of_group(condition) (condition)
#endif

// Cuts a part if it waits for that.
void cut(CellPart part, inout bool waits, inout RaySum sum) {
    // This is a loop and not an if, because software rasterisers compute both sides of branches.
    while (waits) {
        add_cut_part(part, sum);
        waits = false;
    }
}

// Adds the part of a ray between two depths to what the ray has passed.
void integrate_cells(Ray ray, REAL2 depths, inout RaySum sum) {
    CellRay cells = cell_ray(ray);
    CellPlace at = place_at(ray, cells, depths.x);
    REAL left = depths.y - depths.x;
    CellPart part;
#ifdef LIGHTS
    part.to_eye = -normalize(vec3(ray.direction) * spacing);
#endif
    // `sum` ends in front of the waiting part or, once that is cut, behind it. `behind` is what
    // follows. `before` are the depth and the transmittance in front of `behind`, as far as they are
    // known without a cut.
    CellPart waiting = part;
    bool waits = false;
    RaySum behind = empty_sum;
    vec2 before = vec2(sum.depth, sum.transmittance);
    bool goes = left > REAL(0.0);
    while (goes || waits) {
        bool hard = false;
#ifdef OCCUPIED_ONLY
        if (goes) {
            ivec3 brick = brick_of(at.cell);
            int reach = distance_to_shown(brick);
            while (reach > 0 && left > REAL(0.0)) {
                leap(ray, cells, brick, reach, depths.y, at, left);
                brick = brick_of(at.cell);
                reach = distance_to_shown(brick);
            }
            goes = left > REAL(0.0);
        }
#endif
        if (goes) {
            vec3 to_faces = (vec3(cells.forward) - at.place) * cells.inverse;
            float way = min(min(to_faces.x, to_faces.y), min(to_faces.z, float(left)));
            vec3 change = way * cells.slope;
            // Roundings may leave a rest of the way behind the box's last cell.
            ivec3 cell = nearest_cell(at.cell);
            bool transparent;
            part.scalar = cell_scalar(cell, at.place + vec3(at.cell - cell), change, transparent);
            part.world_length = transparent ? 0.0 : way * float(ray.length_per_depth);
#ifdef LIGHTS
            part.cell = at.cell;
            part.place = at.place;
            part.change = change;
            part.transmittance = before.y * behind.transmittance;
            part.longest_piece = 1.0;
#endif
            hard = !add_whole_part(part, behind);
            bvec3 leaves = lessThanEqual(to_faces, vec3(way));
            at.place = mix(clamp(at.place + change, 0.0, 1.0), vec3(not(cells.forward)), leaves);
            at.cell += ivec3(leaves) * (2 * ivec3(cells.forward) - 1);
            left -= REAL(way);
        }
#ifndef CUTS_ALONE
        bool second = hard && waits;
        bool some_second = any_of_group(second), some_goes = any_of_group(goes);
        if (second || some_second || !some_goes) cut(waiting, waits, sum);
#ifdef ENDS_EARLY
        if (sum.depth >= opaque_depth) {  // what follows is hidden
            behind = empty_sum;
            hard = false;
            goes = false;
        }
#endif
#endif
        if (hard) {
            put_behind(behind, sum);
            before = vec2(sum.depth + part.depth, sum.transmittance * exp(-part.depth));
            behind = empty_sum;
            waiting = part;
            waits = true;
        }
#ifdef CUTS_ALONE
        cut(waiting, waits, sum);
#endif
        goes = goes && left > REAL(0.0);
#ifdef ENDS_EARLY
        goes = goes && max(sum.depth, before.x + behind.depth) < opaque_depth;
#endif
    }
    put_behind(behind, sum);
}
