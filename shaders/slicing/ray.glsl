// SPDX-License-Identifier: Apache-2.0
// Computes the viewing ray of a pixel in the texture's index space: origin + depth * direction,
// where depth is eye-space depth from the front of the nearest slab. The processor computes all
// coefficients in double precision, relative to the box, so that neither a far eye nor far world
// coordinates cost accuracy. PRECISE_RAYS: rays stay double until lengths are known, because those
// that graze a face, and boxes much thinner than long, lose several digits in float.
#ifdef PRECISE_RAYS
#define REAL double
#define REAL2 dvec2
#define REAL3 dvec3
#define REAL4 dvec4
#else
#define REAL float
#define REAL2 vec2
#define REAL3 vec3
#define REAL4 vec4
#endif

uniform vec2 image_middle;      // in pixels
uniform REAL slab_thickness;    // in eye-space depth
uniform REAL3 origin_middle;    // origin of the ray through the image's middle
uniform REAL3 origin_column;    // change of the origin per pixel to the right
uniform REAL3 origin_row;       // change of the origin per pixel downwards
uniform REAL3 direction_middle;
#ifndef ORTHOGRAPHIC
uniform REAL3 direction_column;
uniform REAL3 direction_row;
uniform float pixel_size;       // width of a pixel at depth 1
#endif

uniform vec3 box_min;  // the texture's part of the volume's box, in its index space
uniform vec3 box_max;
uniform vec3 last_face;  // box_max, or beyond all places (slicing/slab_geometry.h)

struct Ray {
    REAL3 origin;
    REAL3 direction;
    REAL length_per_depth;  // world units
};

#ifdef CLIP_PLANES
#include "slicing/clip.glsl"
#endif

// `place`: the pixel's middle, in pixels from the image's left and top edge.
Ray view_ray(vec2 place) {
    REAL2 pixel = REAL2(place - image_middle);  // exact
    Ray ray;
    ray.origin = origin_middle + pixel.x * origin_column + pixel.y * origin_row;
    ray.direction = direction_middle;
    ray.length_per_depth = REAL(1.0);
#ifndef ORTHOGRAPHIC
    ray.direction += pixel.x * direction_column + pixel.y * direction_row;
    ray.length_per_depth = sqrt(REAL(1.0) + dot(pixel, pixel) * REAL(pixel_size) * REAL(pixel_size));
#endif
    return ray;
}

vec3 point_at(Ray ray, REAL depth) { return vec3(ray.origin + depth * ray.direction); }

// Returns the depths of the front and the back of `count` slabs from number `slab` on.
REAL2 slab_depths(float slab, float count) { return REAL2(REAL(slab), REAL(slab + count)) * slab_thickness; }

// Returns the slabs, of `count` from `slab` on, in which a part of the ray may lie: the first of
// them, and the one behind the last.
vec2 slabs_of(REAL2 depths, float slab, float count) {
    float first = floor(float(depths.x / slab_thickness)) - 1.0;
    float end = ceil(float(depths.y / slab_thickness)) + 1.0;
    return vec2(max(slab, first), min(slab + count, end));
}

// Returns the depths between which the ray is inside the box and in the range `slab`; y <= x if
// there are none. A ray that runs in a first face of the box (smallest coordinate) is inside; a ray
// in a last face is inside only if that face is last_face.
REAL2 clip_to_box(Ray ray, REAL2 slab) {
    const REAL3 least = REAL3(1e-20);  // a ray that runs along a face never crosses it
    // A ray that runs in a face is taken to be slowly leaving the face, into the box if the face
    // counts as inside.
    REAL3 along = mix(least, -least, equal(ray.origin, REAL3(last_face)));
    REAL3 direction = mix(ray.direction, along, lessThan(abs(ray.direction), least));
    REAL3 inverse = REAL3(1.0) / direction;
    REAL3 one = (REAL3(box_min) - ray.origin) * inverse;
    REAL3 other = (REAL3(box_max) - ray.origin) * inverse;
    REAL3 enter = min(one, other);
    REAL3 leave = max(one, other);
    REAL2 inside = REAL2(max(slab.x, max(enter.x, max(enter.y, enter.z))),
                         min(slab.y, min(leave.x, min(leave.y, leave.z))));
#ifdef CLIP_PLANES  // and on the kept side of the clip
    inside = clip_to_planes(ray, inside);
#endif
    return inside;
}
