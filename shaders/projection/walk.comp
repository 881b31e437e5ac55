#version 450 core
// SPDX-License-Identifier: Apache-2.0
// Walks the ray of each pixel through a mesh, front to back:
//
//   for each open face by which the ray enters the mesh, nearest first:
//       while there is a tet behind the face:
//           move through the tet to the face by which the ray leaves it       (walk_mesh.glsl)
//           composite the segment between both faces, piece by piece          (tet_color.glsl)
//
// No tet needs to be in order, and meshes may have rings, gaps and hollows. A dispatch takes `rounds` steps of a ray at
// most and keeps its state for the next one. A workgroup draws a tile of 8 x 8 pixels, for which the open faces are
// listed that its rays may enter. A piece ends at the tet's faces, at points of the transfer function and where it gets
// deep (SOURCE_PARTS), and at the near plane. Each takes a round of the one loop: software rasterisers skip no
// branches, and an inner loop costs them more than a piece.
#include "gl/tile.glsl"
#include "projection/sources.glsl"
#include "projection/walk_mesh.glsl"

struct FragmentSegment {
    float front, back;  // scalars, normalised
    float world_length;
#ifdef LIT
    vec3 front_gradient, back_gradient;
    vec3 to_eye;
#endif
};
FragmentSegment segment;
FragmentSegment find_segment() { return segment; }
#if SOURCE == SOURCE_PARTS
OPTICS low_optics, high_optics;
#include "projection/walk_pieces.glsl"
#endif
#include "projection/tet_color.glsl"

// The ray of a pixel between two dispatches.
struct Ray {
    uvec4 front;         // corners of the face by which it enters the next tet; the tet, or no_tet
    uint last_entry;     // the open face by which it entered the mesh last, or no_tet
    uint entries_left;   // open faces by which it enters behind that one; 1 if they are not counted
    double entry_depth;  // of the last entry
    // The search for the next entry: listed faces that are done, entries among them, and the first of these.
    uint searched, entries;
    double first_depth;
    uint first_entry, first_tet;
};
layout(std430, binding = 0) buffer Pixels { vec4 pixels[]; };  // associated colour, row 0 on top
layout(std430, binding = 1) buffer Rays { Ray rays[]; };       // 64 a tile
layout(std430, binding = 2) buffer Unfinished { uint unfinished; };

uniform usamplerBuffer tiles;         // first column, first row, first and last + 1 entry of `listed_faces`
uniform usamplerBuffer listed_faces;  // numbers of open faces
uniform int first_tile;               // of the dispatch
uniform ivec2 image_size;
uniform int picture_row;    // pixels in a row of the buffer
uniform bool begins;        // this is the first dispatch of these tiles
uniform int rounds;         // fewer than software rasterisers allow for all loops of an invocation together
uniform double near_depth;  // from the mesh's center

// Opacity above which nothing behind can be seen: it hides all but 1e-6 of it, or 2.6e-4 / 255.
const float opaque = 0.999999;

// Ends a ray that makes no progress in a tet, which would stop a GPU: many more pieces than any has.
const int least_left = -(1 << 20);

// Finds the first entry behind the last one, and counts the entries. Returns the tet, or no_tet; also if it ends early,
// after `left` rounds.
uint find_entry(uvec2 list, inout Ray ray, inout int left, inout Front front) {
    for (; left > 0 && list.x + ray.searched < list.y; --left, ++ray.searched) {
        uint face = texelFetch(listed_faces, int(list.x + ray.searched)).x;
        uvec4 corners = texelFetch(open_faces, int(face));
        Front seen = front_of(corners.xyz);
        double depth = crossing_of(seen).depth;
        bool behind = ray.last_entry == no_tet || depth > ray.entry_depth ||
                      (depth == ray.entry_depth && face > ray.last_entry);
        if (!behind || !enters(seen)) continue;
        ++ray.entries;
        bool nearest = depth < ray.first_depth || (depth == ray.first_depth && face < ray.first_entry);
        if (ray.entries > 1u && !nearest) continue;
        ray.first_entry = face;
        ray.first_tet = corners.w;
        ray.first_depth = depth;
    }
    if (list.x + ray.searched < list.y) return no_tet;
    ray.last_entry = ray.first_entry;
    ray.entry_depth = ray.first_depth;
    ray.entries_left = max(ray.entries, 1u) - 1u;
    uint tet = ray.entries > 0u ? ray.first_tet : no_tet;
    ray.searched = ray.entries = 0u;
    if (tet != no_tet) front = front_of(texelFetch(open_faces, int(ray.first_entry)).xyz);
    return tet;
}

// Walks from a face of the mesh or within it to the next exit, and composites the pieces on the way. Ends early if
// nothing behind is seen, or at the first face after `left` rounds.
void walk(inout uint tet, inout Front front, inout int left, inout vec4 color) {
    Passage passage;  // `from` moves on from piece to piece
    passage.behind = tet;
    passage.from = crossing_of(front);
    bool shown = false, through = true;  // through: the ray is at the end of the passage
#if SOURCE == SOURCE_PARTS
    take_interval(find_interval(clamp(passage.from.scalar, 0.0, 1.0)));
#endif
    while (true) {
        --left;
        if (color.a > opaque || left < least_left) {
            tet = no_tet;
            return;
        }
        if (through) {
            tet = passage.behind;
            if (tet == no_tet || left <= 0) return;
            uint combined = WORD_OF(tets, tet);
            uvec4 behind = WORDS_OF(neighbors, tet);
            shown = (combined & hidden_tet) == 0u;
            passage = pass_through(tet, combined & ~hidden_tet, behind, passage.from, front);
#if SOURCE == SOURCE_PARTS && defined(COPIES)
            take_interval(find_interval(clamp(passage.from.scalar, 0.0, 1.0)));
#endif
        }
        Crossing from = passage.from, end = passage.to;
        bool hidden = from.depth < near_depth;  // in front of the near plane
        int next_interval = 0;  // relative to this one
#if SOURCE == SOURCE_PARTS
        bool rising = end.scalar >= from.scalar;
        float knot = rising ? interval_ends.y : interval_ends.x;
        if (rising ? end.scalar >= knot : end.scalar < knot) {
            end = between(from, end, abs(knot - from.scalar) / max(abs(end.scalar - from.scalar), 1e-37));
            end.scalar = knot;
            next_interval = rising ? 1 : -1;
        }
#endif
        through = next_interval == 0;
        if (hidden && end.depth > near_depth) {
            end = between(from, end, float((near_depth - from.depth) / (end.depth - from.depth)));
            end.depth = near_depth;
            next_interval = 0;
            through = false;
        }
        segment.front = from.scalar;
        segment.back = end.scalar;
        segment.world_length = float(end.depth - from.depth) * length_per_depth;
#if SOURCE == SOURCE_PARTS
        segment.front = share_of_interval(segment.front);
        segment.back = share_of_interval(segment.back);
#ifdef TABLE_COLORED
        vec2 extinctions = low_optics.a + vec2(segment.front, segment.back) * (high_optics.a - low_optics.a);
        float thin = thin_share(extinctions.x * segment.world_length, extinctions.y * segment.world_length);
        if (thin < 1.0 && shown && !hidden) {
            end = between(from, end, thin);
            segment.world_length *= thin;
            segment.back = mix(segment.front, segment.back, thin);
            next_interval = 0;
            through = false;
        }
#endif
#endif
#ifdef LIT
        segment.front_gradient = clamp(passage.gradient_scale * from.gradient, -1.0, 1.0);
        segment.back_gradient = clamp(passage.gradient_scale * end.gradient, -1.0, 1.0);
        segment.to_eye = to_eye;
#endif
        if (shown && !hidden) color += (1.0 - color.a) * tet_color();
        passage.from = end;
#if SOURCE == SOURCE_PARTS
        if (next_interval != 0) take_interval(interval + next_interval);
#endif
    }
}

void main() {
    uvec4 tile = texelFetch(tiles, first_tile + int(gl_WorkGroupID.x));
    ivec2 pixel = ivec2(tile.xy) + pixel_in_tile();
    if (any(greaterThanEqual(pixel, image_size))) return;
    int place = pixel.y * picture_row + pixel.x;
    uint number = gl_WorkGroupID.x * 64u + gl_LocalInvocationIndex;
    aim(vec2(pixel.x + 0.5, image_size.y - pixel.y - 0.5));

    vec4 color = vec4(0.0);
    Ray ray = Ray(uvec4(0u, 0u, 0u, no_tet), no_tet, 1u, 0.0LF, 0u, 0u, 0.0LF, no_tet, no_tet);
    Front front;
    if (!begins) {
        ray = rays[number];
        color = pixels[place];
        if (ray.front.w != no_tet) front = front_of(ray.front.xyz);
    }
    uint tet = ray.front.w;
    int left = rounds;
    while (left > 0 && (tet != no_tet || ray.entries_left > 0u)) {
        --left;
        if (tet == no_tet) tet = find_entry(tile.zw, ray, left, front);
        if (tet != no_tet) walk(tet, front, left, color);
        if (color.a > opaque) {
            tet = no_tet;
            ray.entries_left = 0u;
        }
    }
    pixels[place] = color;
    if (tet == no_tet && ray.entries_left == 0u) {
        rays[number].front.w = no_tet;
        rays[number].entries_left = 0u;
    } else {
        ray.front = uvec4(front.a.point, front.b.point, front.c.point, tet);
        rays[number] = ray;
        atomicAdd(unfinished, 1u);
    }
}
