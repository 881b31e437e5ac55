// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "reference/emission_integral.h"

namespace lamina {

// Pieces of one ray, whose emission is integrated in vectors.
struct EmissionBatch {
    static constexpr std::size_t capacity = 32;

    // EmissionPiece, coefficient by coefficient.
    alignas(64) double position[4][capacity];
    alignas(64) double extinction[4][capacity];
    alignas(64) double depth[capacity];       // optical depth of the piece, >= 0
    alignas(64) double before[capacity];      // and of what lies in front of it
    alignas(64) double color_span[capacity];  // largest change of a colour
    // The errors that are allowed to a channel of the ray: to each piece by its length, and to all
    // of them by the opacity that is seen.
    alignas(64) double error_of_length[capacity];
    double error_of_opacity;

    // The results: of each piece exp(-before), 1 - exp(-depth), and what integrate_emission()
    // returns.
    alignas(64) double transmittance[capacity];
    alignas(64) double opacity[capacity];
    alignas(64) double value[capacity];
    alignas(64) double error[capacity];

    std::size_t count = 0;

    void add(const EmissionPiece& piece, double depth_before, double depth_of_piece,
             double allowed_by_length, double span) {
        for (std::size_t power = 0; power < 4; ++power) {
            position[power][count] = piece.position.c[power];
            extinction[power][count] = piece.extinction.c[power];
        }
        before[count] = depth_before;
        depth[count] = depth_of_piece;
        error_of_length[count] = allowed_by_length;
        color_span[count] = span;
        ++count;
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
void integrate_emission(EmissionBatch& batch);

}  // namespace lamina
