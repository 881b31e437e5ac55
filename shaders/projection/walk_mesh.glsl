// SPDX-License-Identifier: Apache-2.0
// A ray's way through a tetrahedral mesh, from face to face: twin of RayWalk (mesh/ray_walk.h). Corners are seen along
// the ray: `place` is (0, 0) on it, and the ray passes an edge on the side that the sign of a triangle's area tells.
// Both tets of a face take the sign of each of its edges from the same numbers, so that no ray leaks between tets, and
// each enters the tet behind a face where it left the one before. GlMeshWalk (projection/gl_mesh_walk.h) describes the
// buffers.
uniform usamplerBuffer tets;       // the corners' numbers, combined by ^, and hidden_tet
uniform usamplerBuffer neighbors;  // tets behind the faces opposite to the corners, by ascending number of these
uniform usamplerBuffer points;     // place in steps of `place_step`, scalar
uniform usamplerBuffer open_faces;

uniform double place_step;

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
    across_x *= place_step;
    across_y *= place_step;
    along = place_step * view_axes[2];
}

// A corner of a face, as seen along the ray.
struct Corner {
    dvec2 place;
    double depth;  // from the mesh's center
    float scalar;
    uint point;
};

Corner see(uint point) {
    uvec4 words = texelFetch(points, int(point));
    dvec3 p = dvec3(ivec3(words.xyz));
    precise double x = p.x * across_x.x + p.y * across_x.y + p.z * across_x.z - ray_place.x;
    precise double y = p.x * across_y.x + p.y * across_y.y + p.z * across_y.z - ray_place.y;
    precise double depth = p.x * along.x + p.y * along.y + p.z * along.z;
    return Corner(dvec2(x, y), depth, uintBitsToFloat(words.w), point);
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
};

Crossing between(Crossing from, Crossing to, float share) {
    share = clamp(share, 0.0, 1.0);
    return Crossing(from.depth + double(share) * (to.depth - from.depth),
                    from.scalar + share * (to.scalar - from.scalar));
}

// Returns where the ray crosses a face. Both tets of the face take the same result, so that weights may be float.
Crossing crossing_of(Front front) {
    float sum = float(front.areas.x + front.areas.y + front.areas.z);
    vec2 weights = sum > 0.0 ? vec2(front.areas.yz) / sum : vec2(1.0, 0.0);  // of a and b
    vec2 depths = vec2(front.a.depth - front.c.depth, front.b.depth - front.c.depth);
    vec2 scalars = vec2(front.a.scalar, front.b.scalar) - front.c.scalar;
    return Crossing(front.c.depth + double(dot(weights, depths)), front.c.scalar + dot(weights, scalars));
}

Front front_of(uvec3 corners) {
    Corner a = see(corners.x), b = see(corners.y), c = see(corners.z);
    return Front(a, b, c, dvec3(area_of(a, b), area_of(b, c), area_of(c, a)));
}

bool enters(Front front) {
    return is_left(front.areas.x, front.a, front.b) && is_left(front.areas.y, front.b, front.c) &&
           is_left(front.areas.z, front.c, front.a);
}

// Moves the ray through a tet: makes `front` the face by which it leaves, and returns the tet behind that face. The
// fourth corner, top, takes the place of the corner that is left behind: the ray leaves between the two corners for
// which the side of the edge to the top turns from right to left.
uint step_through(uint tet, uint corners, inout Front front) {
    Corner top = see(corners ^ front.a.point ^ front.b.point ^ front.c.point);
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
    uint below = uint(front.a.point < left_behind) + uint(front.b.point < left_behind) +
                 uint(front.c.point < left_behind);
    uvec4 behind = texelFetch(neighbors, int(tet));
    return below == 0u ? behind.x : below == 1u ? behind.y : below == 2u ? behind.z : behind.w;
}
