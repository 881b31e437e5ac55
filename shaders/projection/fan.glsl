// SPDX-License-Identifier: Apache-2.0
// Finds the optics of a fragment of the triangles of Kraus 2004. The inputs are the members of FanVertex
// (projection/fan_geometry.h), interpolated.
in vec3 inverse;       // 1 / z at the front and at the back, and their difference; if not DIVIDED, z is the thickness
in vec4 front_values;  // scalar in x, or colour and extinction; divided by z if DIVIDED
in vec4 back_values;
flat in vec2 scalars;  // least and largest scalar of the tet
flat in uint tet;

uint cell_fragment_number() { return tet; }

#if defined(ORTHOGRAPHIC) || defined(LINEAR)
#define DIVIDED 0
#else
#define DIVIDED 1
uniform vec2 image_middle;
uniform float pixel_size;  // world units, at z = 1
#endif

struct TetOptics {
    vec4 front, back;  // colour, extinction
    float world_length;
};

// Returns the optics at both ends of the ray's segment, and its length (Kraus 2004, section 2.3). The thickness comes
// from the difference of the inverse depths, which is interpolated itself and so keeps its digits (docs/numerics.md,
// section 6).
TetOptics find_optics() {
#if DIVIDED
    float z_front = 1.0 / inverse.x;
    float z_back = 1.0 / inverse.y;
    float world_length = max(inverse.z, 0.0) * z_front * z_back;
#ifndef THICKNESS_DZ
    vec2 from_middle = (gl_FragCoord.xy - image_middle) * pixel_size;
    world_length *= sqrt(1.0 + dot(from_middle, from_middle));
#endif
    return TetOptics(front_values * z_front, back_values * z_back, world_length);
#else
    return TetOptics(front_values, back_values, max(inverse.z, 0.0));
#endif
}

// Returns the interpolated colour and opacity of the vertices (SOURCE_VERTICES).
vec4 vertex_values() { return front_values; }

// The segment of the ray inside the tet.
struct FragmentSegment {
    float front, back;   // scalars, normalised
    float world_length;
};

FragmentSegment find_segment() {
    TetOptics optics = find_optics();
    vec2 ends = clamp(vec2(optics.front.x, optics.back.x), scalars.x, scalars.y);
    return FragmentSegment(ends.x, ends.y, optics.world_length);
}
