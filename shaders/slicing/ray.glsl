// SPDX-License-Identifier: Apache-2.0
// The viewing ray of a fragment in the brick's index space: origin + depth * direction, where depth is eye-space depth
// relative to the middle of the slabs. All coefficients come from the processor in double precision and near the box,
// so that neither a far eye nor far world coordinates cost accuracy.
uniform vec2 image_middle;      // in pixels
uniform vec3 origin_middle;     // of the ray through the image's middle
uniform vec3 origin_column;     // change per pixel to the right
uniform vec3 origin_row;        // and downwards
uniform vec3 direction_middle;
#ifndef ORTHOGRAPHIC
uniform vec3 direction_column;
uniform vec3 direction_row;
uniform float pixel_size;       // at depth 1
#endif

struct Ray {
    vec3 origin;
    vec3 direction;
    float length_per_depth;  // world units
};

Ray view_ray(vec2 fragment) {
    vec2 pixel = (fragment - image_middle) * vec2(1.0, -1.0);
    Ray ray;
    ray.origin = origin_middle + pixel.x * origin_column + pixel.y * origin_row;
    ray.direction = direction_middle;
    ray.length_per_depth = 1.0;
#ifndef ORTHOGRAPHIC
    ray.direction += pixel.x * direction_column + pixel.y * direction_row;
    ray.length_per_depth = sqrt(1.0 + dot(pixel, pixel) * pixel_size * pixel_size);
#endif
    return ray;
}

// The depths between which the ray is inside the box and inside the slab; y <= x where it is not.
vec2 clip_to_box(Ray ray, vec2 slab, vec3 box_min, vec3 box_max) {
    vec3 direction = mix(ray.direction, vec3(1e-20), lessThan(abs(ray.direction), vec3(1e-20)));
    vec3 inverse = 1.0 / direction;
    vec3 one = (box_min - ray.origin) * inverse;
    vec3 other = (box_max - ray.origin) * inverse;
    vec3 enter = min(one, other);
    vec3 leave = max(one, other);
    return vec2(max(slab.x, max(enter.x, max(enter.y, enter.z))),
                min(slab.y, min(leave.x, min(leave.y, leave.z))));
}
