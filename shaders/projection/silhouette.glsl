// SPDX-License-Identifier: Apache-2.0
// Finds the segment of a pixel's ray inside a cell fragment: a tet, or the region of one on which the transfer function
// is linear. It comes from the planes of the faces (projection/tet_record.h). Coverage, too, is decided here, because
// the polygon covers a little more than the tet, and rasterisers move its corners.
//
// CAREFUL: depths are double, for faces seen nearly edge-on, tets at the near plane, and an eye inside the tet.
// EXACT_SEGMENTS: so are lengths and scalars. CUT: the cell fragment ends at planes of constant scalar. WINDOW_PLACE:
// the pixel's window coordinates.
#include "projection/silhouette_record.glsl"

#ifdef CAREFUL
uniform dvec3 ray_perturbation;  // pixels: moves rays along faces to one side, equal for all tets
uniform float near_depth;  // depth (projection/tet_record.h) of the near plane
#endif
#ifdef LIT
uniform vec4 view_axes[3];  // unit vectors to the right, up and forward, in world space
#endif

uniform vec2 image_middle;  // window coordinates
uniform float pixel_size;   // world units, at z = 1

#ifdef OPACITY_ONLY
// The number of cell fragments of the mesh over that of the leaf which is drawn (docs/numerics.md, section 3). It
// scales the length, because optical depth is mean extinction times length.
uniform float depth_scale;
#endif

// Returns the number of the cell fragment, for random numbers.
uint cell_fragment_number() { return floatBitsToUint(limits.w); }

uint front_faces() { return floatBitsToUint(limits.z) & 7u; }

struct FragmentSegment {
    float front, back;   // scalars, normalised to the range of the table or of the cell fragment
    float world_length;  // 0 if the ray misses the tet
#ifdef LIT
    vec3 front_gradient, back_gradient;
    vec3 to_eye;  // unit vector
#endif
};

#ifdef CAREFUL
dvec4 four_doubles(vec4 high, vec4 low) { return dvec4(high) + dvec4(low); }

// Returns a pixel's place, relative to the center, with the ray perturbation. This moves the ray in space; its
// component along the ray does not count.
dvec2 moved_place(vec2 place) {
    dvec2 from_middle = dvec2((WINDOW_PLACE - image_middle) * pixel_size);
    return dvec2(place) + ray_perturbation.xy - ray_perturbation.z * from_middle;
}

dvec4 depths_of_faces(dvec2 moved) {
    return four_doubles(face_depths[0], face_depths[1]) + four_doubles(face_depths[2], face_depths[3]) * moved.x +
           four_doubles(face_depths[4], face_depths[5]) * moved.y;
}

// Returns the depths, minus the center's, between which the ray is inside the tet. They are double because the depth on
// a face that is nearly edge-on changes steeply from pixel to pixel, and both tets that share the face must find the
// ray's crossing in the same place.
dvec2 find_exact_depths(dvec2 moved) {
    dvec4 depths = depths_of_faces(moved);
    uint fronts = front_faces();
    double enter = double(near_depth - center.z);
    enter = max(enter, fronts > 0u ? depths.x : enter);
    enter = max(enter, fronts > 1u ? depths.y : enter);
    enter = max(enter, fronts > 2u ? depths.z : enter);
    double leave = depths.w;
    leave = min(leave, fronts > 0u ? leave : depths.x);
    leave = min(leave, fronts > 1u ? leave : depths.y);
    leave = min(leave, fronts > 2u ? leave : depths.z);
    return dvec2(enter, leave);
}

#ifndef EXACT_SEGMENTS
vec2 find_depths(vec2 place) { return vec2(find_exact_depths(moved_place(place))); }
#elif defined(SCALARS)
// Returns the scalars at both depths. They are double because a scalar within the window is a small difference of large
// numbers in a tet whose scalars reach far outside it (facts/drawn_range.h).
vec2 exact_ends(dvec2 depths, dvec2 moved) {
    dvec4 of = dvec4(scalars) + dvec4(scalars_low);
#ifdef ORTHOGRAPHIC
    dvec2 from_center = depths;
    dvec2 reach = dvec2(1.0);
#else
    dvec2 reach = -1.0 / min(double(center.z) + depths, dvec2(-1e-30));
    dvec2 from_center = depths * reach * (-1.0 / double(center.z));
#endif
    return vec2(of.x + from_center * of.y + reach * dot(moved, of.zw));
}
#endif
#else
// Returns the depths in float32, for tets with 1 to 3 front faces, none of them nearly edge-on.
vec2 find_depths(vec2 place) {
    vec4 depths = face_depths[0] + face_depths[1] * place.x + face_depths[2] * place.y;
    uint fronts = front_faces();
    bool two = fronts > 1u, three = fronts > 2u;
    float enter = depths.x;
    enter = max(enter, two ? depths.y : enter);
    enter = max(enter, three ? depths.z : enter);
    float leave = depths.w;
    leave = min(leave, two ? leave : depths.y);
    leave = min(leave, three ? leave : depths.z);
    return vec2(enter, leave);
}
#endif

#ifdef CUT
// Returns the piece of a ray's segment on which the scalar is between the cell fragment's least and largest. Both cell
// fragments at a cut compute the same numbers for it, so that nothing between them is lost or counted twice.
vec2 cut_depths(vec2 depths, vec2 place) {
    uint fronts = floatBitsToUint(limits.z);
    bool lower_front = (fronts & 8u) != 0u, upper_front = (fronts & 16u) != 0u;
    precise float lower = cuts.x + cuts.y * place.x + cuts.z * place.y;
    precise float upper = cuts.w + limits.x * place.x + limits.y * place.y;
    float enter = max(depths.x, lower_front ? lower : depths.x);
    float leave = min(depths.y, lower_front ? depths.y : lower);
    return vec2(max(enter, upper_front ? upper : enter), min(leave, upper_front ? leave : upper));
}
#endif

#ifdef LIT
// Sets the values that light needs. `from_center`: the distances along z of the segment's ends behind the center.
// `reach`: their z, or 1 if rays are parallel.
void find_gradients(vec2 place, vec2 from_center, vec2 reach, inout FragmentSegment segment) {
    for (int axis = 0; axis < 3; ++axis) {
        vec4 of = gradients[axis];
        vec2 ends = of.x + from_center * of.y + reach * dot(place, of.zw);
        ends = clamp(ends, -1.0, 1.0);  // rounding in slivers may make it longer than at the points
        segment.front_gradient[axis] = ends.x;
        segment.back_gradient[axis] = ends.y;
    }
#ifdef ORTHOGRAPHIC
    segment.to_eye = -view_axes[2].xyz;
#else
    vec2 from_middle = (WINDOW_PLACE - image_middle) * pixel_size;
    segment.to_eye = -normalize((view_axes[2] + from_middle.x * view_axes[0] + from_middle.y * view_axes[1]).xyz);
#endif
}
#endif

FragmentSegment find_segment() {
    vec2 place = WINDOW_PLACE - center.xy;  // exact
#ifdef EXACT_SEGMENTS
    dvec2 moved = moved_place(place);
    dvec2 exact_depths = find_exact_depths(moved);
    // Depths rounded to float decide whether the ray meets the tet: far outside the tet on a steep face, the doubles
    // have errors, too.
    vec2 depths = vec2(exact_depths);
    exact_depths = depths.y > depths.x ? exact_depths : dvec2(0.0);
    depths = vec2(exact_depths);
    float difference = float(exact_depths.y - exact_depths.x);
#else
    vec2 depths = find_depths(place);
#ifdef CUT
    depths = cut_depths(depths, place);
#endif
    depths = depths.y > depths.x ? depths : vec2(0.0);  // missed: finite numbers, and no length
    float difference = depths.y - depths.x;
#endif
    FragmentSegment segment;
#ifdef ORTHOGRAPHIC
    segment.world_length = difference;
    vec2 from_center = depths;
    vec2 reach = vec2(1.0);
#else
    // z = -1 / depth. Differences of z are computed from differences of depth, so that a far eye costs no digits
    // (docs/numerics.md, section 6).
    vec2 z = -1.0 / min(center.z + depths, -1e-30);
    segment.world_length = difference * z.x * z.y;
#ifndef THICKNESS_DZ
    vec2 from_middle = (WINDOW_PLACE - image_middle) * pixel_size;
    segment.world_length *= sqrt(1.0 + dot(from_middle, from_middle));
#endif
    vec2 from_center = depths * z * center.w;
    vec2 reach = z;
#endif
#ifdef OPACITY_ONLY
    segment.world_length *= depth_scale;
#endif
#ifdef LIT
    find_gradients(place, from_center, reach, segment);
#endif
#ifdef SCALARS
#ifdef EXACT_SEGMENTS
    vec2 ends = exact_ends(exact_depths, moved);
#else
    vec2 ends = scalars.x + from_center * scalars.y + reach * dot(place, scalars.zw);
#endif
#ifdef CUT
    ends = clamp(ends, 0.0, 1.0);
#else
    ends = clamp(ends, limits.x, limits.y);
#endif
    segment.front = ends.x;
    segment.back = ends.y;
#else
    segment.front = 0.0;
    segment.back = 0.0;
#endif
    return segment;
}
