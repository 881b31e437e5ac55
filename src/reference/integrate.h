// SPDX-License-Identifier: Apache-2.0
// What a ray sees of its pieces. On a piece of a cubic segment the position x(t) in the interval
// and the extinction e(t) are cubics, and D(t), the integral of e, is the optical depth
// (docs/numerics.md, section 9.2). The change of the colour shows by the integral of x e exp(-D):
//
//   integral(from, to):
//       opacity = exp(-D(from)) - exp(-D(to)), which is the integral of e exp(-D)
//       if the opacity is negligible beside the error that is allowed: x(middle) opacity
//       Patterson's rules of 3, 7 and 15 nodes of x e exp(-D), and of e exp(-D) to see what they
//           miss
//       if two that follow each other differ by no more than is allowed: the finer one
//       otherwise integral(from, middle) + integral(middle, to)
//
// The rules on whole pieces are computed in vectors. Pieces of linear segments have closed forms
// (optics/segment_integral.h).
#pragma once

#include "reference/cut.h"

namespace lamina {
namespace patterson {

// Patterson's nested extensions of the 3-point Gauss-Legendre rule (Patterson 1968, Math. Comp. 22,
// 847-856), exact to degree 5, 11 and 23: entry 0 is the centre, entry i > 0 the pair 1/2 +-
// node[i] of [0, 1].
inline constexpr double node[8] = {0,
                                   0.3872983346207416885,
                                   0.2171218746734012790,
                                   0.4802456343540101417,
                                   0.1116933432144834408,
                                   0.3105514733686132015,
                                   0.4442296164361284994,
                                   0.4969159816063775111};
inline constexpr double weight3[2] = {0.4444444444444444444, 0.2777777777777777778};
inline constexpr double weight7[4] = {0.2254582693292370712, 0.1342440449341667204,
                                      0.2006987073879811115, 0.0523281130132336326};
inline constexpr double weight15[8] = {
    0.1127552498991033437, 0.06720762762189211018, 0.1003142646884945105,  0.02580164149853986985,
    0.1095784292007937482, 0.08575595456819569039, 0.04646359765756226884, 0.00850085981497013017};

}  // namespace patterson

// A piece whose opacity is this share of the error allowed to it gets any of its colours.
inline constexpr double negligible_opacity = 1.0 / 1024;
// Depth that 15 nodes resolve. Deeper pieces are bisected, which is cheaper.
inline constexpr double resolvable_depth = 8;
// Rounding of a rule's sums, relative to the optical depth.
inline constexpr double emission_rounding = 1e-15;

struct EmissionIntegral {
    double value = 0;
    double error = 0;  // estimate of |error|; the true error is smaller, up to rounding
};

// Returns the integral of x(t) extinction(t) exp(-depth(t)) over [0, 1], which lies between 0 and 1
// - exp(-depth(1)). Each interval may contribute an error of `error_per_t` times its length plus
// `error_per_opacity` times its share of 1 - exp(-depth(1)). depth(1) may have any value: a
// boundary layer is found by bisection, and what it hides is not refined.
EmissionIntegral integrate_emission(const EmissionPiece& piece, double error_per_t,
                                    double error_per_opacity);

// Sets the results of all pieces.
void integrate_emission(PieceBatch& batch);

// Sets the results of all pieces. The relative error of each weight is some 1e-13
// (optics/segment_integral.h).
void weigh_pieces(LinearPieces& pieces);

}  // namespace lamina
