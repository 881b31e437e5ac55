// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "reference/cut_round.h"
#include "reference/emission_integral.h"

namespace lamina {

// Pieces of one ray, front to back, whose emission is integrated in vectors. A piece is the part of
// a segment (SegmentBatch) on which the transfer function is linear.
struct PieceBatch {
    using Column = std::vector<double>;

    std::vector<std::int64_t> segment, interval;  // numbers
    Column from, to;                              // parameters of the segment, 0 <= from < to <= 1
    Column start, end;                            // the scalar there
    Column position[4], extinction[4];            // EmissionPiece, coefficient by coefficient
    Column depth;                                 // optical depth of the piece, >= 0
    Column before;                                // and of what lies in front of it
    Column color_span;                            // largest change of a colour
    // The errors that are allowed to a channel of the ray: to each piece by its length, and to all
    // of them by the opacity that is seen.
    Column error_of_length;
    double error_of_opacity = 0;

    // The results: of each piece exp(-before), 1 - exp(-depth), and what integrate_emission()
    // returns.
    Column transmittance, opacity, value, error;

    std::size_t count = 0;

    std::vector<CutRound> rounds;  // memory of append_pieces()

    // Makes sure that columns have room for so many pieces, and a vector of doubles more: vectors
    // read and write beyond the last piece, and find numbers there that are valid.
    void make_room(std::size_t pieces) {
        if (pieces + longest_vector <= from.size()) return;
        const std::size_t room = std::max(2 * from.size(), pieces + longest_vector);
        segment.resize(room);
        interval.resize(room);
        for (Column* column : {&from, &to, &start, &end, &depth, &before, &color_span,
                               &error_of_length, &transmittance, &opacity, &value, &error})
            column->resize(room);
        for (std::size_t power = 0; power < 4; ++power) {
            position[power].resize(room);
            extinction[power].resize(room);
        }
    }

    EmissionPiece piece(std::size_t number) const {
        EmissionPiece piece;
        for (std::size_t power = 0; power < 4; ++power) {
            piece.position.c[power] = position[power][number];
            piece.extinction.c[power] = extinction[power][number];
        }
        return piece;
    }
};

// Sets the results of all pieces.
void integrate_emission(PieceBatch& batch);

}  // namespace lamina
