// SPDX-License-Identifier: Apache-2.0
// Adds parts of rays, front to back. A part lies in one cell, so its scalar is a cubic. Parts that cross points of the
// transfer function, or that are too deep for one rule, are cut.
#include "optics/cell_optics.glsl"

// The sum of the parts that a ray has passed: associated colour, optical depth and transmittance.
struct PartSum {
    vec3 color;
    float depth;
    float transmittance;
};

#ifndef SINGLE_COLOR
// Returns the associated colour of a part in one interval.
vec3 color_of(Interval interval, LinearPart part, float depth, float opacity) {
    // The shortest parts may still be too deep: their colour hardly changes.
    float share = depth > largest_part_depth ? opacity * clamp(part.share.x, 0.0, 1.0)
                                             : seen_share(part, depth, opacity);
    return interval.left.rgb * opacity + interval.change.rgb * share;
}

// Adds a part of that colour and opacity.
void composite(vec3 color, float opacity, inout PartSum sum) {
    sum.color += sum.transmittance * color;
    sum.transmittance -= sum.transmittance * opacity;
}
#endif

// Adds a part in one interval.
void add_linear_part(Interval interval, LinearPart part, float depth, inout PartSum sum) {
    sum.depth += depth;
#ifndef SINGLE_COLOR
    float opacity = opacity_from_depth(depth);
    composite(color_of(interval, part, depth, opacity), opacity, sum);
#endif
}

#ifndef SINGLE_COLOR
// Shortens a part from its back while it is too deep. Returns whether it was left whole.
bool shorten(inout LinearPart part, inout float extent) {
    const float shortest = 1e-6;
    bool whole = true;
    for (float depth = depth_of(part); depth > largest_part_depth && extent > shortest; depth = depth_of(part)) {
        whole = false;
        // Optical depth grows at least with the first power of the extent from a place at which it
        // is 0; a root does not overshoot if it grows with the second.
        float share = clamp(sqrt(0.7 / depth), min(shortest / extent, 0.5), 0.5);
        extent *= share;
        part.extinction *= share;
        part.change *= share;
        part.share.yzw *= share * vec3(1.0, share, share * share);
    }
    return whole;
}
#endif

// Optical depth behind which nothing is visible.
bool is_opaque(PartSum sum) {
#ifdef SINGLE_COLOR
    return sum.depth > 20.0;
#else
    return sum.transmittance < 1e-9;
#endif
}

// A cubic from a place on: there its value is `scalar`, and the interval of the transfer function
// is given.
struct CutPlace {
    float t, scalar;
    int interval;
};

// Returns the beginning of a cubic. At an end of an interval it begins on the side to which it
// goes.
CutPlace first_place(vec4 cubic, vec2 turns) {
    int interval = find_interval(clamp(cubic.x, 0.0, 1.0));
    bool falling = cubic_at(cubic, turns.x) < cubic.x;
    if (falling && interval > 0 && interval_place(interval).x == cubic.x) --interval;
    return CutPlace(0.0, cubic.x, interval);
}

// The monotone piece of a part from a place on, as far as it stays in one interval.
struct Stretch {
    Interval interval;
    float to, at_to;    // its end, and the scalar there
    int next_interval;  // behind its end
};

Stretch next_stretch(vec4 cubic, vec2 turns, CutPlace place) {
    float end = place.t < turns.x ? turns.x : place.t < turns.y ? turns.y : 1.0;
    float at_end = cubic_at(cubic, end);
    bool rising = at_end >= place.scalar;
    Interval interval = interval_at(place.interval);
    float knot = rising ? interval.right_end : place.interval == 0 ? -3e38 : interval.left_end;
    bool crosses = rising ? knot < at_end : knot > at_end;
    float to = crosses ? cubic_root(cubic, knot, vec2(place.t, end), vec2(place.scalar, at_end)) : end;
    return Stretch(interval, to, crosses ? knot : at_end, place.interval + (crosses ? rising ? 1 : -1 : 0));
}

// Returns the piece of `extent` from a place on, up to a place at which the scalar is `at_end`.
LinearPart piece_from(CutPlace place, Interval interval, vec4 cubic, float extent, float at_end, float world_length) {
    vec4 piece = vec4(place.scalar, 0.0, (cubic.z + 3.0 * cubic.w * place.t) * extent * extent,
                      cubic.w * extent * extent * extent);
    piece.y = (at_end - place.scalar) - (piece.z + piece.w);
    return linear_part(interval, piece, world_length * extent);
}

// Moves a place to the end of a stretch, or by a piece of `extent`.
void advance(Stretch stretch, vec4 cubic, bool whole, float extent, inout CutPlace place) {
    float shortened = max(place.t + extent, place.t + 6e-8);
    place.t = whole ? stretch.to : shortened;
    place.scalar = whole ? stretch.at_to : cubic_at(cubic, shortened);
    if (whole) place.interval = stretch.next_interval;
}

#ifdef LIGHTS
#include "slicing/lit_cell.glsl"
#else
// Adds the next stretch of a part, or the beginning of it, and moves the place to its end.
void add_piece(vec4 cubic, vec2 turns, float world_length, inout CutPlace place, inout PartSum sum) {
    Stretch stretch = next_stretch(cubic, turns, place);
    float extent = max(stretch.to - place.t, 0.0);
    LinearPart part = piece_from(place, stretch.interval, cubic, extent, stretch.at_to, world_length);
#ifdef SINGLE_COLOR
    const bool whole = true;
#else
    bool whole = shorten(part, extent);
#endif
    add_linear_part(stretch.interval, part, depth_of(part), sum);
    advance(stretch, cubic, whole, extent, place);
}

void add_cut_part(vec4 cubic, float world_length, inout PartSum sum) {
    vec2 turns = cubic_turns(cubic);
    CutPlace place = first_place(cubic, turns);
    while (place.t < 1.0 && !is_opaque(sum)) add_piece(cubic, turns, world_length, place, sum);
}

// Adds a part whose scalar is a cubic.
void add_part(vec4 cubic, float world_length, inout PartSum sum) {
    vec2 range = clamp(cubic_range(cubic), 0.0, 1.0);
    Interval interval = interval_at(find_interval(range.x));
    LinearPart part = linear_part(interval, cubic, world_length);
    bool crosses = range.y > interval.right_end;
    float depth = crosses ? 0.0 : depth_of(part);
    bool hard = crosses && range.y > interval.shown_beyond;
#ifndef SINGLE_COLOR
    hard = hard || depth > largest_part_depth;
#endif
    if (!hard) add_linear_part(interval, part, depth, sum);
    // A loop, because software rasterisers skip loops but not branches.
    while (hard) {
        add_cut_part(cubic, world_length, sum);
        hard = false;
    }
}
#endif
