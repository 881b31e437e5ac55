// SPDX-License-Identifier: Apache-2.0
// Integrates the visible colour of the pieces of a ray. On a piece of a cubic segment, the position
// x(t) in the transfer function's interval and the extinction e(t) are cubics, and D(t), the
// integral of e, is the optical depth (docs/numerics.md, section 9.2). The colour is linear in x,
// so the piece needs only two integrals: of e exp(-D), which is its opacity, and of x e exp(-D):
//   integral(from, to):
//       opacity = exp(-D(from)) - exp(-D(to)), which is the integral of e exp(-D)
//       if the opacity is negligible against the allowed error: return x(middle) * opacity
//       apply Patterson's rules of 3, 7 and 15 nodes to x e exp(-D), and to e exp(-D), whose exact
//           integral shows a rule's error
//       if two successive rules differ by no more than is allowed: return the finer one
//       otherwise return integral(from, middle) + integral(middle, to)
// Pieces of linear segments have closed forms (optics/segment_integral.h).
//
// The colour that light adds to a piece (docs/numerics.md, section 10.3), for the gradient g and
// each light's direction l and halfway vector h:
//   kinks = the roots of g.l and g.h
//   for each interval of the piece between two kinks:
//       ball = a ball around g in the middle that contains g on the interval
//       if the largest effect of light for gradients in the ball (10.2) is below the allowed error:
//           add opacity * the effect in the middle
//       else if g changes its length and its direction by little in the ball:
//           add the finer of two successive of Patterson's rules, if they agree
//       if nothing was added: halve the interval
// The effect has narrow dips and peaks if the gradient is small and turns quickly.
#pragma once

#include "optics/ray_lights.h"
#include "reference/cut.h"

namespace lamina {
namespace patterson {

// Patterson's nested extensions of the 3-point Gauss-Legendre rule (1968, Math. Comp. 22, 847-856),
// exact to degree 5, 11 and 23: entry 0 is the centre, i > 0 the pair 1/2 +- node[i] of [0, 1].
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

// Opacity of a piece, as a share of its allowed error, below which any colour of the piece will do.
inline constexpr double negligible_opacity = 1.0 / 1024;
// Optical depth that 15 nodes resolve. Deeper pieces are bisected at once, which is cheaper.
inline constexpr double resolvable_depth = 8;
// Rounding error of a rule's sums, relative to the optical depth (for light, to that plus 1).
inline constexpr double emission_rounding = 1e-15;

// The integral of a quantity f(t), weighted by extinction * exp(-depth), over 0 <= t <= 1.
template <typename Value>
struct Integral {
    Value value{0};
    double error = 0;  // estimate of the worst component's error; the true error is smaller
};
using EmissionIntegral = Integral<double>;

// Returns the integral of x * extinction * exp(-depth) over [0, 1]. The error allowed on each
// interval is `error_per_t` times its length plus `error_per_opacity` times its visible opacity.
EmissionIntegral integrate_emission(const EmissionPiece& piece, double error_per_t,
                                    double error_per_opacity);

void integrate_emission(PieceBatch& batch);

// Computes the weights of the pieces' colours in vectors; their error is some 1e-13.
void weigh_pieces(LinearPieces& pieces);

// A piece with a gradient, whose colour is linear in x.
struct LitPiece {
    EmissionPiece emission;
    glm::dvec3 color{0}, color_change{0};  // at x = 0, and from there to x = 1
    GradientAlong gradient;
};

using LightIntegral = Integral<glm::dvec3>;

// Integrates RayLights::Effect::on(colour), otherwise as integrate_emission() integrates x.
LightIntegral integrate_light(const LitPiece& piece, const RayLights& lights, double error_per_t,
                              double error_per_opacity);

}  // namespace lamina
