// SPDX-License-Identifier: Apache-2.0
// Twin of optics/extinction_pieces.h: the mean extinction over a straight run of the scalar, normalised to [0, 1], in
// closed form (with EXACT_OPACITY). Differences of nearby floats are exact, and no term is negative: short runs lose nothing. With
// PIECE_NODES, also where the run's ends lie in a table whose nodes are equally spaced within each piece.
uniform vec4 extinction_pieces[PIECES];  // left and right end, extinction at the left one, half its change per scalar
#ifdef PIECE_NODES
uniform vec2 piece_nodes[PIECES];  // nodes per scalar; nodes skipped at the right end
#endif

struct ExtinctionRun {
    float mean;
    vec2 nodes;  // of the lesser and of the larger scalar
};

void add_piece(inout ExtinctionRun run, int i, float from, float to) {
    vec4 piece = extinction_pieces[i];
    float a = clamp(from, piece.x, piece.y);
    float b = clamp(to, piece.x, piece.y);
#ifdef EXACT_OPACITY
    run.mean += (b - a) * (piece.z + piece.w * ((a - piece.x) + (b - piece.x)));
#endif
#ifdef PIECE_NODES
    run.nodes += (vec2(a, b) - piece.x) * piece_nodes[i].x;
#ifdef SKIPPED_NODES
    run.nodes += step(piece.y, vec2(from, to)) * piece_nodes[i].y;
#endif
#endif
}

// Written out, because software rasterisers run loops at several times the cost of what is in them.
ExtinctionRun find_run_of(float front, float back) {
    const float least_width = 1.0 / 2097152.0;
    float from = min(min(front, back), 1.0 - least_width);
    float to = max(max(front, back), from + least_width);
    ExtinctionRun run = ExtinctionRun(0.0, vec2(0.0));
    add_piece(run, 0, from, to);
#if PIECES > 1
    add_piece(run, 1, from, to);
#endif
#if PIECES > 2
    add_piece(run, 2, from, to);
#endif
#if PIECES > 3
    add_piece(run, 3, from, to);
#endif
#if PIECES > 4
    add_piece(run, 4, from, to);
#endif
#if PIECES > 5
    add_piece(run, 5, from, to);
#endif
#if PIECES > 6
    add_piece(run, 6, from, to);
#endif
#if PIECES > 7
    add_piece(run, 7, from, to);
#endif
#if PIECES > 8
    for (int i = 8; i < PIECES; ++i) add_piece(run, i, from, to);
#endif
    run.mean = max(run.mean, 0.0) / (to - from);
    return run;
}
