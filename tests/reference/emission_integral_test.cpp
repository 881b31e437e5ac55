// SPDX-License-Identifier: Apache-2.0
#include "reference/emission_integral.h"

#include <gtest/gtest.h>

#include "fixtures.h"
#include "optics/segment_integral.h"

namespace lamina {
namespace {

using reference_test::Random;

// Position and extinction linear in t: the weight of the back end is the integral
// (docs/numerics.md, section 5), in closed form. From 1e-8 to 1e7, so boundary layers as thin as
// 1e-7 of the piece.
TEST(EmissionIntegral, LinearPiecesEqualTheClosedForm) {
    for (const double p : {0.0, 1e-8, 1e-3, 0.5, 3.0, 20.0, 1e3, 1e5, 1e7}) {
        for (const double q : {0.0, 1e-8, 1e-2, 1.0, 7.0, 50.0, 1e4, 1e7}) {
            const EmissionPiece piece{{{0, 1, 0, 0}}, {{p, q - p, 0, 0}}};
            const EmissionIntegral found = integrate_emission(piece, 1e-13, 1e-13);
            const double expected = piece_weights(p, q).back;
            // Allowed 2e-13, and rounding: depth(t) near the front is good to 1e-16 of p.
            EXPECT_NEAR(found.value, expected, 5e-13) << "p " << p << " q " << q;
            EXPECT_LE(found.error, 3e-13) << "p " << p << " q " << q;
        }
    }
}

// A cubic position under constant extinction s: the integrals of t^n s exp(-s t) by recurrence,
// I_n = n / s I_(n-1) - exp(-s), I_0 = 1 - exp(-s).
TEST(EmissionIntegral, CubicPositionUnderConstantExtinction) {
    for (const double s : {2.0, 10.0, 300.0, 1e5, 1e7}) {
        const EmissionPiece piece{{{0.25, 1.5, -2.0, 1.0}}, {{s, 0, 0, 0}}};
        double moment = -std::expm1(-s), expected = 0.25 * moment;
        for (std::size_t n = 1; n < 4; ++n) {
            moment = static_cast<double>(n) / s * moment - std::exp(-s);
            expected += piece.position.c[n] * moment;
        }
        const EmissionIntegral found = integrate_emission(piece, 1e-13, 1e-13);
        EXPECT_NEAR(found.value, expected, 5e-13) << s;  // as above
    }
}

TEST(EmissionIntegral, EstimateCoversTheErrorAndKeepsTheTolerance) {
    Random random(5);
    for (int i = 0; i < 3000; ++i) {
        EmissionPiece piece;
        const double strength = std::pow(10, random.uniform(-3, 7));
        // Bernstein coefficients in [0, 1] keep the cubic there.
        const double b0 = random.uniform(), b1 = random.uniform(), b2 = random.uniform(),
                     b3 = random.uniform();
        piece.position.c = {b0, 3 * (b1 - b0), 3 * (b2 - 2 * b1 + b0), b3 - 3 * b2 + 3 * b1 - b0};
        for (std::size_t n = 0; n < 4; ++n) piece.extinction.c[n] = strength * piece.position.c[n];
        const EmissionIntegral exact = integrate_emission(piece, 1e-13, 1e-13);
        for (const double tolerance : {1e-2, 1e-4, 1e-6, 1e-9}) {
            const EmissionIntegral found = integrate_emission(piece, tolerance / 2, tolerance / 2);
            EXPECT_LE(found.error, tolerance) << strength;
            EXPECT_LE(std::abs(found.value - exact.value), found.error + exact.error + 1e-14)
                << strength << " tolerance " << tolerance;
        }
    }
}

}  // namespace
}  // namespace lamina
