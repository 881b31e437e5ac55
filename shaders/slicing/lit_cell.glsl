// SPDX-License-Identifier: Apache-2.0
// Integrates and composites lit parts of rays, as slicing/cut_cell.glsl does unlit ones. Parts
// along which light bends too much are cut, too.
#include "slicing/cell_light.glsl"

// The part of a ray in one cell, from `place` to place + change.
struct CellPart {
    CellScalar scalar;
    float world_length;
    ivec3 cell;
    vec3 place, change;
    vec3 to_eye;          // direction along the grid's axes
    float transmittance;  // of what is in front, without crossings since the last part that was hard
    float depth;          // set by add_whole_part(): the optical depth if it lies in one interval, else 0
    float longest_piece;  // of the first piece if it is cut, as a share of it: 1, or less if its light bends
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
void add_lit_piece(CellPart cell, vec2 turns, CellGradient gradient, inout PieceLength pieces, inout CutPlace place,
                   inout RaySum sum) {
    NextPiece next_piece = find_next_piece(cell.scalar, turns, place);
    float extent = max(next_piece.t_to - place.t, 0.0);
    bool to_end = extent <= pieces.longest;
    extent = min(extent, pieces.longest);
    float at_end = to_end ? next_piece.s_to : scalar_at(cell.scalar, place.t + extent);
    LinearPart part =
        piece_from(place, next_piece.interval, cell.scalar.cubic, extent, at_end, cell.world_length);
    bool whole = shorten(part, extent);
    float depth = depth_of(part), opacity = opacity_from_depth(depth);
    vec3 color = color_of(next_piece.interval, part, depth, opacity);
    float bend = add_light(gradient, cell.to_eye, next_piece.interval, part, place.t, extent, depth, opacity, color);
    bool again = extent > shortest_lit_piece && bends(bend, sum.transmittance * opacity);
    choose_length(again, whole && to_end, whole && !to_end, extent, pieces);
    if (again) return;
    sum.depth += depth;
    composite(color, opacity, sum);
    advance(next_piece, cell.scalar, whole && to_end, extent, place);
}

// Adds a part piece by piece.
void add_cut_part(CellPart cell, inout RaySum sum) {
    CellGradient gradient = cell_gradient(cell.cell, cell.place, cell.change);
    vec2 turns = cubic_turns(cell.scalar.cubic);
    CutPlace place = first_place(cell.scalar, turns);
    PieceLength pieces = PieceLength(cell.longest_piece, cell.longest_piece, false);
    while (place.t < 1.0 && !is_opaque(sum)) add_lit_piece(cell, turns, gradient, pieces, place, sum);
}

// Adds light to a part in one interval, and then the part to the sum. Returns false, and adds
// nothing, if the part must be cut because its light bends too much.
bool add_part_in_interval(Interval interval, LinearPart part, inout CellPart cell, inout RaySum sum) {
    bool added = true;
    bool shown = cell.depth > 0.0;
    // This is a loop and not an if, because software rasterisers compute both sides of branches.
    while (shown) {
        shown = false;
        CellGradient gradient = cell_gradient(cell.cell, cell.place, cell.change);
        float opacity = opacity_from_depth(cell.depth);
        vec3 color = color_of(interval, part, cell.depth, opacity);
        float bend = add_light(gradient, cell.to_eye, interval, part, 0.0, 1.0, cell.depth, opacity, color);
        added = !bends(bend, cell.transmittance * opacity);
        if (added) {
            sum.depth += cell.depth;
            composite(color, opacity, sum);
        } else {
            cell.longest_piece = longest_piece(bend);
        }
    }
    return added;
}
