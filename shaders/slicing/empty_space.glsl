// SPDX-License-Identifier: Apache-2.0
// Finds the slabs in which a ray comes near visible min/max bricks of the volume. The distance of
// the brick at the ray's place gives a cube of bricks that shows nothing; slabs that end before the
// ray leaves this cube are empty.
#include "slicing/brick_distances.glsl"

const float brick_edge = float(BRICK_EDGE);

// A ray in units of min/max bricks: start + d * change, where d is the depth from its entry into
// the box.
struct BrickRay {
    vec3 start;
    vec3 change;
    vec3 inverse;   // 1 / change
    float margin;   // largest error of a point, in bricks
    REAL entry;     // depth at which it enters the box
};

BrickRay brick_ray(Ray ray, REAL entry) {
    BrickRay bricks;
    vec3 change = vec3(ray.direction) / brick_edge;
    bricks.start = (point_at(ray, entry) + first_sample) / brick_edge;
    bricks.change = mix(change, vec3(1e-20), lessThan(abs(change), vec3(1e-20)));
    bricks.inverse = 1.0 / bricks.change;
    // A hundredth of a voxel, plus 16 roundings to float of the largest coordinate, which counts if
    // the ray begins far from the box.
    vec3 size = abs(vec3(ray.origin)) / brick_edge + last_distance + 1.0;
    bricks.margin = 0.01 / brick_edge + 1e-6 * max(size.x, max(size.y, size.z));
    bricks.entry = entry;
    return bricks;
}

// Consecutive slabs, and whether they may be visible.
struct SlabRange {
    float end;   // the slab behind the last one
    bool shown;
};

// Returns the slabs from number `slab` on that are known to be empty. If `slab` itself may be
// visible, returns the slabs up to the next one that is worth testing.
SlabRange next_slab_range(BrickRay ray, float slab) {
    float depth = float(REAL(slab) * slab_thickness - ray.entry);
    vec3 place = ray.start + depth * ray.change;
    vec3 brick = floor(clamp(place, vec3(0.0), last_distance));
    float to_shown = float(distance_to_shown(ivec3(brick)));
    float reach = max(to_shown, 1.0);
    vec3 ahead = vec3(reach - ray.margin), behind = vec3(1.0 - reach + ray.margin);
    vec3 leave = (brick + mix(behind, ahead, greaterThan(ray.change, vec3(0.0))) - place) * ray.inverse;
    // If the point is closer to a side of the cube than the margin, it may lie outside the cube.
    bool between = all(greaterThanEqual(place - brick, behind)) && all(lessThanEqual(place - brick, ahead));
    float exit = float(ray.entry) + depth + min(leave.x, min(leave.y, leave.z));
    float end = floor(exit / float(slab_thickness));
    bool empty = to_shown > 0.0 && between && end > slab;
    return SlabRange(empty ? end : to_shown > 0.0 ? slab + 1.0 : max(end, slab + 1.0), !empty);
}
