// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "lamina/transfer_function.h"

namespace lamina {

// A Gauss-Legendre rule on [0, 1], computed with 40 digits.
struct GaussRule {
    std::size_t points;  // number of entries of x and weight
    const double* x;
    const double* weight;
};

inline constexpr double gauss4_x[] = {0.06943184420297371239, 0.3300094782075718676,
                                      0.6699905217924281324, 0.9305681557970262876};
inline constexpr double gauss4_weight[] = {0.1739274225687269287, 0.3260725774312730713,
                                           0.3260725774312730713, 0.1739274225687269287};
inline constexpr GaussRule gauss4{4, gauss4_x, gauss4_weight};

inline constexpr double gauss5_x[] = {0.046910077030668003601, 0.23076534494715845448, 0.5,
                                      0.76923465505284154552, 0.9530899229693319964};
inline constexpr double gauss5_weight[] = {0.11846344252809454376, 0.23931433524968323402,
                                           0.28444444444444444444, 0.23931433524968323402,
                                           0.11846344252809454376};
inline constexpr GaussRule gauss5{5, gauss5_x, gauss5_weight};

inline constexpr double gauss6_x[] = {0.033765242898423986094, 0.16939530676686774317,
                                      0.38069040695840154568,  0.61930959304159845432,
                                      0.83060469323313225683,  0.96623475710157601391};
inline constexpr double gauss6_weight[] = {0.08566224618958517252, 0.18038078652406930378,
                                           0.23395696728634552369, 0.23395696728634552369,
                                           0.18038078652406930378, 0.08566224618958517252};
inline constexpr GaussRule gauss6{6, gauss6_x, gauss6_weight};

inline constexpr double gauss8_x[] = {
    0.01985507175123188416, 0.1016667612931866302, 0.2372337950418355071, 0.4082826787521750975,
    0.5917173212478249025,  0.7627662049581644929, 0.8983332387068133698, 0.9801449282487681158};
inline constexpr double gauss8_weight[] = {
    0.05061426814518812958, 0.1111905172266872353, 0.1568533229389436437, 0.1813418916891809915,
    0.1813418916891809915,  0.1568533229389436437, 0.1111905172266872353, 0.05061426814518812958};
inline constexpr GaussRule gauss8{8, gauss8_x, gauss8_weight};

inline constexpr double gauss16_x[] = {
    0.005299532504175033702, 0.02771248846338371196, 0.06718439880608412806, 0.1222977958224984831,
    0.1910618777986781258,   0.2709916111713863068,  0.3591982246103705434,  0.4524937450811812799,
    0.5475062549188187201,   0.6408017753896294566,  0.7290083888286136932,  0.8089381222013218742,
    0.8777022041775015169,   0.9328156011939158719,  0.972287511536616288,   0.9947004674958249663};
inline constexpr double gauss16_weight[] = {
    0.01357622970587704743, 0.03112676196932394643, 0.0475792558412463924,  0.06231448562776693603,
    0.07479799440828836604, 0.08457825969750126909, 0.09130170752246179443, 0.09472530522753424814,
    0.09472530522753424814, 0.09130170752246179443, 0.08457825969750126909, 0.07479799440828836604,
    0.06231448562776693603, 0.0475792558412463924,  0.03112676196932394643, 0.01357622970587704743};
inline constexpr GaussRule gauss16{16, gauss16_x, gauss16_weight};

// Optical depth from which closed forms lose no digits; below it Gauss' rules are used.
inline constexpr double largest_gauss_depth = 4;

// Returns the rule for a piece of optical depth D with k, half the change of extinction * length,
// |k| <= D. The error of n points, about (n!)^3 / ((2n+1) (2n)!^2) |k|^n, is below 1e-15 of D.
inline const GaussRule& gauss_rule(double depth) {
    if (depth < 0.016) return depth < 1e-3 ? gauss4 : gauss5;
    if (depth < 0.5) return depth < 0.09 ? gauss6 : gauss8;
    return gauss16;
}

struct SegmentIntegral {
    double optical_depth = 0;
    double alpha = 0;     // 1 - exp(-optical_depth)
    glm::dvec3 color{0};  // associated, seen from the front: attenuated by the segment itself
};

// Weights (>= 0) of the colours at both ends of a piece with linear colour and extinction; their
// sum is the opacity. p, q: extinction times length at front and back, >= 0 and finite.
struct PieceWeights {
    double front = 0;
    double back = 0;
};
PieceWeights piece_weights(double p, double q);

// Integrates a segment with linear scalar from `front` (near the eye) to `back`, `length` >= 0
// world units long (docs/numerics.md, section 5). Relative error: 1e-13 for depths 1e-300 to 1e300.
SegmentIntegral integrate_segment(const TransferFunction& transfer_function, double front,
                                  double back, double length);

// Returns the integral of (1 - x)^2 over a piece, x from 0 at its front to 1 at its back, weighted
// by visible opacity (extinction times transmittance); error 1e-8. p and q: as for piece_weights().
double front_moment(double p, double q);

// Opacity and colour of a segment under a light factor that falls linearly from 1 at its front to 0
// at its back (docs/numerics.md, section 10; Lum, Wilson, Ma 2004).
struct FrontParts {
    double alpha = 0;
    glm::dvec3 color{0};
};

// A segment without light, and its FrontParts: together they give it under any linear light factor.
struct LitIntegral {
    SegmentIntegral whole;
    FrontParts front;
};

// Integrates as integrate_segment() does. `front` is accurate to about 1e-8 of `whole`.
LitIntegral integrate_lit_segment(const TransferFunction& transfer_function, double front,
                                  double back, double length);

// A piece of a segment: linear colour and extinction, from `from` to `to` (shares of the segment).
struct SegmentPiece {
    OpticalProperties front, back;
    double length = 0, from = 0, to = 1;
};
// Returns what the piece adds to the segment's FrontParts if nothing lies in front of it.
FrontParts front_parts_of(const SegmentPiece& piece);

// Fast approximations of piece_weights(p, q).front follow; shaders/optics/linear_segment.glsl has
// twins of thin_front_weight() and FrontWeightTable. The error of a ray's colour is at most the
// weight's error times the sum of the colour's changes along the ray.

// Largest depth (p + q) / 2 for thin_front_weight(): error <= 3e-5, value <= the piece's opacity.
inline constexpr double thin_depth = 1.5;
double thin_front_weight(double p, double q);

// Largest depth for faint_front_weight(), a shorter polynomial, whose error is at most 3e-7.
inline constexpr double faint_depth = 0.2;
double faint_front_weight(double p, double q);

// Front weights, interpolated bilinearly between nodes equally spaced in p / (1 + p) and 1 - 1 /
// sqrt(1 + q). Error <= 2e-5 for p, q < 20, 5e-4 anywhere; for faint pieces 2.2e-3 of opacity.
class FrontWeightTable {
  public:
    static constexpr int nodes = 256;

    static const FrontWeightTable& get();  // built at the first call

    // nodes * nodes values, index row * nodes + column: columns by p, rows by q.
    const std::vector<float>& texels() const { return texels_; }
    // p, q >= 0. The result is at most the piece's opacity.
    double lookup(double p, double q) const;

  private:
    FrontWeightTable();

    std::vector<float> texels_;
};

}  // namespace lamina
