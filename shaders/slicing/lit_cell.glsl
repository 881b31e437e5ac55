// SPDX-License-Identifier: Apache-2.0
// Adds lit parts of rays. Parts along which light bends are cut, too.
#include "slicing/cell_light.glsl"

// A step of a ray in one cell, and the direction to the eye, along the grid's axes.
struct LitStep {
    ivec3 cell;
    vec3 place, change;
    vec3 to_eye;
};

// Lengths of the pieces of a part. The length doubles after two of that length: so pieces whose
// light bends too much overlap only if one is at least twice as long as the other, which bounds
// their number (plan/classification_choice.cpp).
struct PieceLength {
    float first;    // beginning of the stretch
    float longest;  // now
    bool passed_one;
};

void choose_length(bool again, bool whole, bool full, float extent, inout PieceLength pieces) {
    float longer = full && pieces.passed_one ? min(2.0 * pieces.longest, 1.0) : pieces.longest;
    pieces.longest = again ? 0.5 * extent : whole ? pieces.first : longer;
    pieces.passed_one = !again && !whole && full != pieces.passed_one;
}

// Adds the next piece of a part, or the beginning of it, and moves the place to its end; if its
// light bends too much it is not added.
void add_lit_piece(vec4 cubic, vec2 turns, float world_length, CellGradient gradient, vec3 to_eye,
                   inout PieceLength pieces, inout CutPlace place, inout PartSum sum) {
    Stretch stretch = next_stretch(cubic, turns, place);
    float extent = max(stretch.to - place.t, 0.0);
    bool to_end = extent <= pieces.longest;
    extent = min(extent, pieces.longest);
    float at_end = to_end ? stretch.at_to : cubic_at(cubic, place.t + extent);
    LinearPart part = piece_from(place, stretch.interval, cubic, extent, at_end, world_length);
    bool whole = shorten(part, extent);
    float depth = depth_of(part), opacity = opacity_from_depth(depth);
    vec3 color = color_of(stretch.interval, part, depth, opacity);
    float bend = add_light(gradient, to_eye, stretch.interval, part, place.t, extent, depth, opacity, color);
    bool again = extent > shortest_lit_piece && bends(bend, sum.transmittance * opacity);
    choose_length(again, whole && to_end, whole && !to_end, extent, pieces);
    if (again) return;
    sum.depth += depth;
    composite(color, opacity, sum);
    advance(stretch, cubic, whole && to_end, extent, place);
}

void add_cut_part(vec4 cubic, float world_length, CellGradient gradient, vec3 to_eye, float longest,
                  inout PartSum sum) {
    vec2 turns = cubic_turns(cubic);
    CutPlace place = first_place(cubic, turns);
    PieceLength pieces = PieceLength(longest, longest, false);
    while (place.t < 1.0 && !is_opaque(sum))
        add_lit_piece(cubic, turns, world_length, gradient, to_eye, pieces, place, sum);
}

// Adds a part whose scalar is a cubic, and along which the ray takes a step.
void add_part(vec4 cubic, float world_length, LitStep way, inout PartSum sum) {
    vec2 range = clamp(cubic_range(cubic), 0.0, 1.0);
    Interval interval = interval_at(find_interval(range.x));
    LinearPart part = linear_part(interval, cubic, world_length);
    bool crosses = range.y > interval.right_end;
    float depth = crosses ? 0.0 : depth_of(part);
    bool hard = crosses && range.y > interval.shown_beyond || depth > largest_part_depth;
    bool shown = hard || depth > 0.0;
    // Loops, because software rasterisers skip loops but not branches.
    while (shown) {
        shown = false;
        CellGradient gradient = cell_gradient(way.cell, way.place, way.change);
        float longest = 1.0;
        if (!hard) {
            float opacity = opacity_from_depth(depth);
            vec3 color = color_of(interval, part, depth, opacity);
            float bend = add_light(gradient, way.to_eye, interval, part, 0.0, 1.0, depth, opacity, color);
            longest = longest_piece(bend);
            hard = bends(bend, sum.transmittance * opacity);
            if (!hard) {
                sum.depth += depth;
                composite(color, opacity, sum);
            }
        }
        while (hard) {
            hard = false;
            add_cut_part(cubic, world_length, gradient, way.to_eye, longest, sum);
        }
    }
}
