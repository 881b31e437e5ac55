// SPDX-License-Identifier: Apache-2.0
// A ray's way through a tetrahedral mesh, from face to face: twin of RayWalk (mesh/ray_walk.h). Corners are seen along
// the ray: `place` is (0, 0) on it, and the ray passes an edge on the side that the sign of a triangle's area tells.
// Both tets of a face take the sign of each of its edges from the same numbers, so that no ray leaks between tets, and
// each enters the tet behind a face where it left the one before. GlMeshWalk (projection/gl_mesh_walk.h) describes the
// buffers.
//
//   tets       the corners' numbers, combined by ^, and hidden_tet
//   neighbors  tets behind the faces opposite to the corners, by ascending number of these
//   points     place in steps of `place_steps`, scalar
//   corners    if COPIES is defined: a tet's corners with values of its own, in the same order
//   gradients  if LIT is defined: of points
//
// They are texels or, with TABLE_BLOCKS, storage blocks.
#ifdef TABLE_BLOCKS
layout(std430, binding = 5) readonly buffer Tets { uint tets[]; };
layout(std430, binding = 6) readonly buffer Neighbors { uvec4 neighbors[]; };
layout(std430, binding = 7) readonly buffer Points { uvec4 points[]; };
#ifdef COPIES
layout(std430, binding = 8) readonly buffer Corners { uvec4 corners[]; };
#endif
#ifdef LIT
layout(std430, binding = 9) readonly buffer Gradients { uvec4 gradients[]; };
#endif
#define WORD_OF(table, place) table[place]
#define WORDS_OF(table, place) table[place]
#else
uniform usamplerBuffer tets;
uniform usamplerBuffer neighbors;
uniform usamplerBuffer points;
#ifdef COPIES
uniform usamplerBuffer corners;
#endif
#ifdef LIT
uniform usamplerBuffer gradients;
#endif
#define WORD_OF(table, place) texelFetch(table, int(place)).x
#define WORDS_OF(table, place) texelFetch(table, int(place))
#endif
uniform usamplerBuffer open_faces;

uniform dvec3 place_steps;       // lengths
uniform dvec3 view_axes[3];      // unit vectors to the right, up and forward, in world space
uniform dvec3 mesh_center;       // from the eye, along these axes
uniform dvec2 image_middle;      // window coordinates
uniform double pixel_size;       // at depth 1, or of parallel rays
uniform dvec3 ray_perturbation;  // pixels: moves rays along faces to one side, equal for all tets

const uint no_tet = 0xffffffffu;
const uint hidden_tet = 0x80000000u;  // marks a tet that shows nothing

// The ray's axes: a point p of the mesh has the place (dot(p, across_x), dot(p, across_y)) - ray_place.
dvec3 across_x, across_y, along;
dvec2 ray_place;
float length_per_depth;  // world units
#ifdef LIT
vec3 to_eye;  // unit vector
#endif

void aim(vec2 window) {
    dvec2 from_middle = (dvec2(window) - image_middle) * pixel_size;
#ifdef ORTHOGRAPHIC
    from_middle += ray_perturbation.xy * pixel_size;
    across_x = view_axes[0];
    across_y = view_axes[1];
    ray_place = from_middle - mesh_center.xy;
    length_per_depth = 1.0;
#else
    from_middle += (ray_perturbation.xy - ray_perturbation.z * from_middle) * pixel_size;
    across_x = view_axes[0] - from_middle.x * view_axes[2];
    across_y = view_axes[1] - from_middle.y * view_axes[2];
    ray_place = from_middle * mesh_center.z - mesh_center.xy;
#ifdef THICKNESS_DZ
    length_per_depth = 1.0;
#else
    length_per_depth = float(sqrt(1.0LF + dot(from_middle, from_middle)));
#endif
#endif
#if defined(LIT) && defined(ORTHOGRAPHIC)
    to_eye = vec3(-view_axes[2]);
#elif defined(LIT)
    to_eye = vec3(-normalize(view_axes[2] + from_middle.x * view_axes[0] + from_middle.y * view_axes[1]));
#endif
    across_x *= place_steps;
    across_y *= place_steps;
    along = place_steps * view_axes[2];
}

// A corner of a face, as seen along the ray.
struct Corner {
    dvec2 place;
    double depth;  // from the mesh's center
    float scalar;
#ifdef LIT
    vec3 gradient;
#endif
    uint point;
};

#ifdef LIT
vec3 gradient_at(uint point) { return uintBitsToFloat(WORDS_OF(gradients, point).xyz); }
#endif

Corner see(uint point) {
    uvec4 words = WORDS_OF(points, point);
    dvec3 p = dvec3(ivec3(words.xyz));
    precise double x = p.x * across_x.x + p.y * across_x.y + p.z * across_x.z - ray_place.x;
    precise double y = p.x * across_y.x + p.y * across_y.y + p.z * across_y.z - ray_place.y;
    precise double depth = p.x * along.x + p.y * along.y + p.z * along.z;
#ifdef LIT
    return Corner(dvec2(x, y), depth, uintBitsToFloat(words.w), gradient_at(point), point);
#else
    return Corner(dvec2(x, y), depth, uintBitsToFloat(words.w), point);
#endif
}

// Returns twice the area of the triangle of the ray and the edge from a to b: exactly minus that from b to a.
double area_of(Corner a, Corner b) {
    precise double area = a.place.x * b.place.y - a.place.y * b.place.x;
    return area;
}

// Tells whether the ray passes the edge from a to b on its left: false for the edge from b to a. If it meets the edge,
// or sees it end-on, it passes it as if it were moved, or the point of the lower number.
bool is_left(double area, Corner a, Corner b) {
    dvec2 edge = b.place - a.place;
    bool lower = a.point < b.point;
    dvec2 other = lower ? b.place : a.place;
    bool end_on = (other.y != 0.0LF ? other.y > 0.0LF : other.x < 0.0LF) == lower;
    bool tied = edge.y != 0.0LF ? edge.y < 0.0LF : edge.x != 0.0LF ? edge.x > 0.0LF : end_on;
    return area != 0.0LF ? area > 0.0LF : tied;
}

// A face of which the ray is inside. The areas belong to the edges ab, bc and ca, counter-clockwise along the ray.
struct Front {
    Corner a, b, c;
    dvec3 areas;
};

// A place on the ray.
struct Crossing {
    double depth;  // from the mesh's center
    float scalar;
#ifdef LIT
    vec3 gradient;
#endif
};

Crossing between(Crossing from, Crossing to, float share) {
    share = clamp(share, 0.0, 1.0);
    from.depth += double(share) * (to.depth - from.depth);
    from.scalar += share * (to.scalar - from.scalar);
#ifdef LIT
    from.gradient += share * (to.gradient - from.gradient);
#endif
    return from;
}

// Returns where the ray crosses a face. Both tets of the face take the same result, so that weights may be float.
Crossing crossing_of(Front front) {
    float sum = float(front.areas.x + front.areas.y + front.areas.z);
    vec2 weights = sum > 0.0 ? vec2(front.areas.yz) / sum : vec2(1.0, 0.0);  // of a and b
    vec2 depths = vec2(front.a.depth - front.c.depth, front.b.depth - front.c.depth);
    vec2 scalars = vec2(front.a.scalar, front.b.scalar) - front.c.scalar;
    Crossing crossing;
    crossing.depth = front.c.depth + double(dot(weights, depths));
    crossing.scalar = front.c.scalar + dot(weights, scalars);
#ifdef LIT
    crossing.gradient = front.c.gradient + weights.x * (front.a.gradient - front.c.gradient) +
                        weights.y * (front.b.gradient - front.c.gradient);
#endif
    return crossing;
}

Front front_of(uvec3 corners) {
    Corner a = see(corners.x), b = see(corners.y), c = see(corners.z);
    return Front(a, b, c, dvec3(area_of(a, b), area_of(b, c), area_of(c, a)));
}

bool enters(Front front) {
    return is_left(front.areas.x, front.a, front.b) && is_left(front.areas.y, front.b, front.c) &&
           is_left(front.areas.z, front.c, front.a);
}

// Returns the entry of a list that belongs to a point: entries belong to four corners by ascending number.
uint entry_of(uint point, uvec4 corners, uvec4 list) {
    uvec4 less = uvec4(lessThan(corners, uvec4(point)));
    uint below = less.x + less.y + less.z + less.w;
    return below == 0u ? list.x : below == 1u ? list.y : below == 2u ? list.z : list.w;
}

#ifdef COPIES
void take_values(inout Corner corner, uvec4 corners_of_tet, uvec4 own) {
    uint point = entry_of(corner.point, corners_of_tet, own);
    corner.scalar = uintBitsToFloat(WORDS_OF(points, point).w);
#ifdef LIT
    corner.gradient = gradient_at(point);
#endif
}
#endif

#ifdef LIT
float largest_part(vec3 v) { return max(max(abs(v.x), abs(v.y)), abs(v.z)); }

// Returns the factor for all gradients in a tet: StoredGradients::scale_of_tet() (projection/tet_projector.h).
float gradient_scale(Front front, Corner top) {
    float largest = max(max(largest_part(front.a.gradient), largest_part(front.b.gradient)),
                        max(largest_part(front.c.gradient), largest_part(top.gradient)));
    return largest > 0.5 ? 0.5 / largest : 1.0;
}
#endif

// A tet and the ray's segment in it.
struct Passage {
    uint behind;  // the tet behind the face by which the ray leaves, or no_tet
    Crossing from, to;
#ifdef LIT
    float gradient_scale;
#endif
};

// Moves the ray through a tet: makes `front` the face by which it leaves. `behind`: the texel of `neighbors`, which is
// fetched beside `tets` and not when the corners are there. `entered`: where the ray enters. The fourth
// corner, top, takes the place of the corner that is left behind: the ray leaves between the two corners for which the
// side of the edge to the top turns from right to left.
Passage pass_through(uint tet, uint combined, uvec4 behind, Crossing entered, inout Front front) {
    Passage passage;
    Corner top = see(combined ^ front.a.point ^ front.b.point ^ front.c.point);
    uvec4 corners_of_tet = uvec4(front.a.point, front.b.point, front.c.point, top.point);
#ifdef COPIES
    uvec4 own = WORDS_OF(corners, tet);
    take_values(front.a, corners_of_tet, own);
    take_values(front.b, corners_of_tet, own);
    take_values(front.c, corners_of_tet, own);
    take_values(top, corners_of_tet, own);
    double depth = entered.depth;
    entered = crossing_of(front);
    entered.depth = depth;
#endif
    passage.from = entered;
#ifdef LIT
    passage.gradient_scale = gradient_scale(front, top);
#endif
    dvec3 to_top = dvec3(area_of(front.a, top), area_of(front.b, top), area_of(front.c, top));
    bool left_a = is_left(to_top.x, front.a, top), left_b = is_left(to_top.y, front.b, top),
         left_c = is_left(to_top.z, front.c, top);
    uint left_behind;
    if (!left_a && left_b) {
        left_behind = front.c.point;
        front.c = top;
        front.areas.yz = dvec2(to_top.y, -to_top.x);
    } else if (!left_b && left_c) {
        left_behind = front.a.point;
        front.a = top;
        front.areas.zx = dvec2(to_top.z, -to_top.y);
    } else {
        left_behind = front.b.point;
        front.b = top;
        front.areas.xy = dvec2(to_top.x, -to_top.z);
    }
    passage.behind = entry_of(left_behind, corners_of_tet, behind);
    passage.to = crossing_of(front);
    passage.to.depth = max(passage.to.depth, entered.depth);
    return passage;
}
