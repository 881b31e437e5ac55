// SPDX-License-Identifier: Apache-2.0
// Integrates parts of rays and composites them front to back. A part lies in one cell, so its
// scalar is a cubic of t = 0 .. 1. An interval lies between two neighbouring points of the transfer
// function (knots). A part that stays in one interval and is shallow is integrated by one rule.
// Other parts are cut where the scalar turns or crosses a knot (find_next_piece), and pieces that
// are still too deep are shortened. CellPart, add_cut_part() and add_part_in_interval() have two
// forms, without light here and with light in slicing/lit_cell.glsl.
#include "optics/cell_optics.glsl"
#include "slicing/ray_sum.glsl"

#ifndef SINGLE_COLOR
// Returns the associated colour of a part in one interval.
vec3 color_of(Interval interval, LinearPart part, float depth, float opacity) {
    // A part that is too short to be shortened may still be too deep for the rule; its colour
    // hardly changes.
    float share = depth > largest_part_depth ? opacity * clamp(part.share.x, 0.0, 1.0)
                                             : seen_share(part, depth, opacity);
    return interval.left.rgb * opacity + interval.change.rgb * share;
}

// Adds a part's associated colour and its opacity.
void composite(vec3 color, float opacity, inout RaySum sum) {
    sum.color += sum.transmittance * color;
    sum.transmittance -= sum.transmittance * opacity;
}
#endif

// Adds a part in one interval.
void add_linear_part(Interval interval, LinearPart part, float depth, inout RaySum sum) {
    sum.depth += depth;
#ifndef SINGLE_COLOR
    float opacity = opacity_from_depth(depth);
    composite(color_of(interval, part, depth, opacity), opacity, sum);
#endif
}

#ifndef SINGLE_COLOR
// Moves the back of a part towards its front until the part is no longer too deep. Returns true if
// nothing was cut off.
bool shorten(inout LinearPart part, inout float extent) {
    const float shortest = 1e-6;  // share of the part at which shortening ends
    bool whole = true;
    for (float depth = depth_of(part); depth > largest_part_depth && extent > shortest; depth = depth_of(part)) {
        whole = false;
        // If the optical depth falls with the first to second power of the extent, sqrt(.7 / depth)
        // leaves .7 or more; but at least half of the extent is cut off. This may have to be
        // repeated.
        float share = clamp(sqrt(0.7 / depth), min(shortest / extent, 0.5), 0.5);
        extent *= share;
        part.extinction *= share;
        part.change *= share;
        part.share.yzw *= share * vec3(1.0, share, share * share);
    }
    return whole;
}
#endif

// Tells whether nothing behind these parts is visible.
bool is_opaque(RaySum sum) {
#ifdef SINGLE_COLOR
    return sum.depth > 20.0;
#else
    return sum.transmittance < 1e-9;
#endif
}

// A place t on a part, with the scalar there and the interval that holds it.
struct CutPlace {
    float t, scalar;
    int interval;
};

// Returns the beginning of a part. If the scalar there is a knot, the interval is the one that the
// scalar enters. `turns`: result of cubic_turns().
CutPlace first_place(CellScalar scalar, vec2 turns) {
    float first = limited(scalar, scalar.cubic.x);
    int interval = find_interval(clamp(first, 0.0, 1.0));
    bool falling = scalar_at(scalar, turns.x) < first;
    if (falling && interval > 0 && interval_place(interval).x == first) --interval;
    return CutPlace(0.0, first, interval);
}

// The longest piece of a part that begins at a given place and over which the scalar is monotone
// and stays in one interval.
struct NextPiece {
    Interval interval;
    float t_to, s_to;   // t at its end, and the scalar there
    int next_interval;  // behind its end
};

NextPiece find_next_piece(CellScalar scalar, vec2 turns, CutPlace place) {
    float end = place.t < turns.x ? turns.x : place.t < turns.y ? turns.y : 1.0;
    float at_end = scalar_at(scalar, end);
    bool rising = at_end >= place.scalar;
    Interval interval = interval_at(place.interval);
    float knot = rising ? interval.right_end : place.interval == 0 ? -3e38 : interval.left_end;
    bool crosses = rising ? knot < at_end : knot > at_end;
    float to = crosses ? cubic_root(scalar.cubic, knot, vec2(place.t, end), vec2(place.scalar, at_end)) : end;
    return NextPiece(interval, to, crosses ? knot : at_end, place.interval + (crosses ? rising ? 1 : -1 : 0));
}

// Returns the piece of length `extent` that begins at a place. Its scalar ends at `at_end` exactly.
LinearPart piece_from(CutPlace place, Interval interval, vec4 cubic, float extent, float at_end, float world_length) {
    vec4 piece = vec4(place.scalar, 0.0, (cubic.z + 3.0 * cubic.w * place.t) * extent * extent,
                      cubic.w * extent * extent * extent);
    piece.y = (at_end - place.scalar) - (piece.z + piece.w);
    return linear_part(interval, piece, world_length * extent);
}

// Moves a place to the end of the next piece if `whole`, else by `extent`, but at least by 6e-8,
// about one float.
void advance(NextPiece next_piece, CellScalar scalar, bool whole, float extent, inout CutPlace place) {
    float shortened = max(place.t + extent, place.t + 6e-8);
    place.t = whole ? next_piece.t_to : shortened;
    place.scalar = whole ? next_piece.s_to : scalar_at(scalar, shortened);
    if (whole) place.interval = next_piece.next_interval;
}

#ifdef LIGHTS
#include "slicing/lit_cell.glsl"
#else
// The part of a ray in one cell.
struct CellPart {
    CellScalar scalar;
    float world_length;
    float depth;  // set by add_whole_part(): the optical depth if the part lies in one interval, else 0
};

// Adds the next piece of a part, or its beginning if it is too deep, and moves the place behind
// what was added.
void add_piece(CellPart cell, vec2 turns, inout CutPlace place, inout RaySum sum) {
    NextPiece next_piece = find_next_piece(cell.scalar, turns, place);
    float extent = max(next_piece.t_to - place.t, 0.0);
    LinearPart part =
        piece_from(place, next_piece.interval, cell.scalar.cubic, extent, next_piece.s_to, cell.world_length);
#ifdef SINGLE_COLOR
    const bool whole = true;
#else
    bool whole = shorten(part, extent);
#endif
    add_linear_part(next_piece.interval, part, depth_of(part), sum);
    advance(next_piece, cell.scalar, whole, extent, place);
}

// Adds a part piece by piece.
void add_cut_part(CellPart cell, inout RaySum sum) {
    vec2 turns = cubic_turns(cell.scalar.cubic);
    CutPlace place = first_place(cell.scalar, turns);
    while (place.t < 1.0 && !is_opaque(sum)) add_piece(cell, turns, place, sum);
}

// Adds a part in one interval.
bool add_part_in_interval(Interval interval, LinearPart part, CellPart cell, inout RaySum sum) {
    add_linear_part(interval, part, cell.depth, sum);
    return true;
}
#endif

// Adds a part by one rule if possible. Returns false if it must be cut.
bool add_whole_part(inout CellPart cell, inout RaySum sum) {
    vec2 range = scalar_range(cell.scalar);
    int lowest = find_interval(range.x);
#ifdef SKIPS_HIDDEN_PARTS
    if (is_hidden(lowest, range)) return true;
#endif
    Interval interval = interval_at(lowest);
    LinearPart part = linear_part(interval, cell.scalar.cubic, cell.world_length);
    bool crosses = range.y > interval.right_end;
    cell.depth = crosses ? 0.0 : depth_of(part);
    bool hard = crosses && range.y > interval.shown_beyond;
#ifndef SINGLE_COLOR
    hard = hard || cell.depth > largest_part_depth;
#endif
    return !hard && add_part_in_interval(interval, part, cell, sum);
}
