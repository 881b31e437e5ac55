// SPDX-License-Identifier: Apache-2.0
// Cuts the segments of a ray at the knots of the transfer function into pieces, on each of which
// extinction and colour are linear functions of the scalar s (docs/numerics.md, section 9.3):
//   t = 0; interval = the one into which s goes from s(0)
//   while t < 1:
//       turn = the next t at which s turns, or 1
//       knot = the end of the interval that s reaches on its way to s(turn)
//       to   = the t at which s is the knot, if that is before the turn; otherwise the turn
//       if the interval has extinction and t < to: append the piece t .. to
//       t = to; interval = the one behind the knot, if s crosses it
// Cells have a cubic s (docs/numerics.md, section 9.1), tets a linear one. Vectors have a segment
// in each lane. The t at which a cubic turns, or has a value:
//   turns: the roots of the derivative inside (0, 1), in the form that does not cancel
//   solve(value, from, to), between two turns:
//       t = the place in from .. to as if the cubic were straight
//       loop: f = cubic(t) - value; t replaces the end of the bracket at which f has the same sign
//           next = t - f / slope, by Newton; the bracket's middle if that is outside or too slow
//           end if the error of the step, bend / slope * step^2 / 2, is below a rounding of t
#pragma once

#include <initializer_list>
#include <limits>

#include "reference/transfer_intervals.h"
#include "simd/lane_set.h"

namespace lamina {

// c[0] + c[1] t + c[2] t^2 + c[3] t^3 on 0 <= t <= 1: a trilinear field along a straight line.
struct Cubic {
    std::array<double, 4> c{};

    double operator()(double t) const { return c[0] + t * (c[1] + t * (c[2] + t * c[3])); }
    double slope(double t) const { return c[1] + t * (2 * c[2] + t * (3 * c[3])); }
    bool constant() const { return c[1] == 0 && c[2] == 0 && c[3] == 0; }
};

using GradientAlong = std::array<Cubic, 3>;

// The turns of a cubic: it is monotone between two neighbours of t[0] = 0 < ... < t[count] = 1.
struct CubicTurns {
    std::array<double, 4> t{0, 1, 1, 1};
    int count = 1;
};
CubicTurns turns_of(const Cubic& cubic);

// Largest number of steps of Newton's method, and the relative precision to which it finds t.
inline constexpr int most_newton_steps = 200;
inline constexpr double root_precision = 0.5 * std::numeric_limits<double>::epsilon();

// Returns the t in [from, to] at which the monotone cubic equals `value`, to full precision.
double solve_monotone(const Cubic& cubic, double value, double from, double to);

// Returns a cubic's part from..to on [0, 1]: exactly `start` at 0 and about `end` at 1.
Cubic restricted(const Cubic& cubic, double from, double to, double start, double end);

struct SegmentBatch {
    static constexpr std::size_t capacity = 32;

    alignas(64) double scalar[4][capacity];  // Cubic, coefficient by coefficient
    alignas(64) double lo[capacity];         // the scalar stays inside [lo, hi] up to rounding
    alignas(64) double hi[capacity];
    alignas(64) double length[capacity];      // > 0, in world units
    alignas(64) std::int64_t cell[capacity];  // index in the CellBatch of make_segments()
    std::size_t count = 0;

    void add(const Cubic& cubic, double least, double most, double world_length) {
        for (std::size_t power = 0; power < 4; ++power) scalar[power][count] = cubic.c[power];
        lo[count] = least;
        hi[count] = most;
        length[count] = world_length;
        ++count;
    }
};

// A piece of a cubic segment: extinction and colour are linear functions of x(t), the place in the
// interval; t goes from 0 (towards the eye) to 1.
struct EmissionPiece {
    Cubic position;    // x(t), in 0..1 up to rounding
    Cubic extinction;  // extinction times the length of the piece, >= 0 up to rounding

    // Returns the optical depth from the front to t (9.2).
    double depth(double t) const {
        const auto& e = extinction.c;
        return t * (e[0] + t * (e[1] / 2 + t * (e[2] / 3 + t * (e[3] / 4))));
    }
};

// A step of the loop: a piece in each `kept` lane, with fields of PieceColumns and of the batches.
struct CutStep {
    alignas(64) std::int64_t interval[longest_vector];
    alignas(64) double start[longest_vector];
    alignas(64) double end[longest_vector];
    std::uint8_t kept;
};
struct CubicStep : CutStep {
    alignas(64) double from[longest_vector];
    alignas(64) double to[longest_vector];
};
struct LinearStep : CutStep {
    alignas(64) double share[longest_vector];
};

struct PieceColumns {
    using Column = std::vector<double>;

    std::vector<std::int64_t> segment, interval;  // indices of each piece's segment and interval
    Column start, end;                            // the scalar at the front and at the back
    Column depth;                                 // optical depth of the piece, >= 0
    Column before;                                // optical depth in front of it, set by the caller
    Column transmittance, opacity;                // results: exp(-before), 1 - exp(-depth)

    std::size_t count = 0;

  protected:
    // Makes the arrays hold `pieces` and a vector more, as vectors go beyond the last piece.
    void make_room(std::size_t pieces, std::initializer_list<Column*> others) {
        if (pieces + longest_vector <= start.size()) return;
        const std::size_t room = std::max(2 * start.size(), pieces + longest_vector);
        segment.resize(room);
        interval.resize(room);
        for (Column* column : {&start, &end, &depth, &before, &transmittance, &opacity})
            column->resize(room);
        for (Column* column : others) column->resize(room);
    }
};

struct PieceBatch : PieceColumns {
    Column from, to;                    // parameters of the segment, 0 <= from < to <= 1
    Column position[4], extinction[4];  // EmissionPiece, coefficient by coefficient
    Column color_span;                  // largest change of a colour component
    // Errors allowed in a channel: error_of_length for each piece, by its length, and
    // error_of_opacity times the visible opacity for all.
    Column error_of_length;
    double error_of_opacity = 0;
    Column value, error;  // results: EmissionIntegral

    std::vector<CubicStep> steps;  // memory of append_pieces()

    void make_room(std::size_t pieces) {
        PieceColumns::make_room(
            pieces, {&from, &to, &color_span, &error_of_length, &value, &error, &position[0],
                     &position[1], &position[2], &position[3], &extinction[0], &extinction[1],
                     &extinction[2], &extinction[3]});
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

// Appends the pieces that have extinction, but leaves `before` and the results unset.
// `error_per_length`: error that a channel may have, per world unit of a piece's length.
void append_pieces(const SegmentBatch& segments, const TransferIntervals& transfer,
                   double error_per_length, PieceBatch& pieces);

struct LinearSegments {
    static constexpr std::size_t capacity = 32;

    alignas(64) double front[capacity];  // scalars
    alignas(64) double back[capacity];
    alignas(64) double length[capacity];  // > 0, in world units
    std::size_t count = 0;

    void add(double at_front, double at_back, double world_length) {
        front[count] = at_front;
        back[count] = at_back;
        length[count] = world_length;
        ++count;
    }
};

struct LinearPieces : PieceColumns {
    Column share;                   // the piece's length as a share of the segment's
    Column start_place, end_place;  // in the interval, 0 at its lower knot, 1 at its upper one
    Column p, q;                    // extinction * length at start and end
    // Result: weight of the interval's change of colour. `opacity` weighs the lower knot's colour.
    Column change;

    std::vector<LinearStep> steps;  // memory of append_linear_pieces()

    void make_room(std::size_t pieces) {
        PieceColumns::make_room(pieces, {&share, &start_place, &end_place, &p, &q, &change});
    }
};

// Appends the pieces that have extinction, front to back, with their depths.
void append_linear_pieces(const LinearSegments& segments, const IntervalColumns& intervals,
                          LinearPieces& pieces);

}  // namespace lamina
