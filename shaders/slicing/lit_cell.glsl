// SPDX-License-Identifier: Apache-2.0
// Integrates and composites lit parts of rays, as slicing/cut_cell.glsl does unlit ones. Parts
// along which light bends too much are cut, too.
#include "slicing/cell_light.glsl"

// A part of a ray in one cell, from `place` to place + change, and the direction to the eye along
// the grid's axes.
struct LitStep {
    ivec3 cell;
    vec3 place, change;
    vec3 to_eye;
};

// Lengths of the pieces of a part, as shares of it. `longest` doubles after two pieces of full
// length whose light bends little enough. So two rejected pieces overlap only if one is at least
// twice as long as the other, which bounds their number (plan/classification_choice.cpp).
struct PieceLength {
    float first;      // largest length just behind a turn of the scalar or a knot
    float longest;    // largest length of the next piece
    bool passed_one;  // one full piece of the present length was added
};

// Chooses the length of the next piece. `again`: the last one bent too much. `whole`: it ended
// where the NextPiece ends. `full`: it had the full length.
void choose_length(bool again, bool whole, bool full, float extent, inout PieceLength pieces) {
    float longer = full && pieces.passed_one ? min(2.0 * pieces.longest, 1.0) : pieces.longest;
    pieces.longest = again ? 0.5 * extent : whole ? pieces.first : longer;
    pieces.passed_one = !again && !whole && full != pieces.passed_one;
}

// Adds the next piece of a part, or its beginning if it is too deep, and moves the place behind
// what was added. If its light bends too much, nothing is added and the next piece is shorter.
void add_lit_piece(CellScalar scalar, vec2 turns, float world_length, CellGradient gradient, vec3 to_eye,
                   inout PieceLength pieces, inout CutPlace place, inout RaySum sum) {
    NextPiece next_piece = find_next_piece(scalar, turns, place);
    float extent = max(next_piece.t_to - place.t, 0.0);
    bool to_end = extent <= pieces.longest;
    extent = min(extent, pieces.longest);
    float at_end = to_end ? next_piece.s_to : scalar_at(scalar, place.t + extent);
    LinearPart part = piece_from(place, next_piece.interval, scalar.cubic, extent, at_end, world_length);
    bool whole = shorten(part, extent);
    float depth = depth_of(part), opacity = opacity_from_depth(depth);
    vec3 color = color_of(next_piece.interval, part, depth, opacity);
    float bend = add_light(gradient, to_eye, next_piece.interval, part, place.t, extent, depth, opacity, color);
    bool again = extent > shortest_lit_piece && bends(bend, sum.transmittance * opacity);
    choose_length(again, whole && to_end, whole && !to_end, extent, pieces);
    if (again) return;
    sum.depth += depth;
    composite(color, opacity, sum);
    advance(next_piece, scalar, whole && to_end, extent, place);
}

// Adds a part piece by piece, the first one at most `longest`.
void add_cut_part(CellScalar scalar, float world_length, CellGradient gradient, vec3 to_eye, float longest,
                  inout RaySum sum) {
    vec2 turns = cubic_turns(scalar.cubic);
    CutPlace place = first_place(scalar, turns);
    PieceLength pieces = PieceLength(longest, longest, false);
    while (place.t < 1.0 && !is_opaque(sum))
        add_lit_piece(scalar, turns, world_length, gradient, to_eye, pieces, place, sum);
}

// Adds a part whose scalar is a cubic, by one rule if possible. `way`: its place in the cell.
void add_part(CellScalar scalar, float world_length, LitStep way, inout RaySum sum) {
    vec2 range = scalar_range(scalar);
    int lowest = find_interval(range.x);
#ifdef SKIPS_HIDDEN_PARTS
    if (is_hidden(lowest, range)) return;
#endif
    Interval interval = interval_at(lowest);
    LinearPart part = linear_part(interval, scalar.cubic, world_length);
    bool crosses = range.y > interval.right_end;
    float depth = crosses ? 0.0 : depth_of(part);
    bool hard = crosses && range.y > interval.shown_beyond || depth > largest_part_depth;
    bool shown = hard || depth > 0.0;
    // These are loops and not ifs, because software rasterisers compute both sides of branches.
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
            add_cut_part(scalar, world_length, gradient, way.to_eye, longest, sum);
        }
    }
}
