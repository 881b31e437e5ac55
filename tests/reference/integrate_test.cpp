// SPDX-License-Identifier: Apache-2.0
#include "reference/integrate.h"

#include <gtest/gtest.h>

#include <vector>

#include "fixtures.h"
#include "optics/segment_integral.h"
#include "reference/cut.h"

namespace lamina {
namespace {

using reference_test::Random;

// Returns a piece with a random cubic position, and extinction `strength` times the position.
EmissionPiece random_piece(Random& random, double strength) {
    // Bernstein coefficients in [0, 1] keep the cubic there.
    const double b0 = random.uniform(), b1 = random.uniform(), b2 = random.uniform(),
                 b3 = random.uniform();
    EmissionPiece piece;
    piece.position.c = {b0, 3 * (b1 - b0), 3 * (b2 - 2 * b1 + b0), b3 - 3 * b2 + 3 * b1 - b0};
    for (std::size_t n = 0; n < 4; ++n) piece.extinction.c[n] = strength * piece.position.c[n];
    return piece;
}

// If position and extinction are linear in t, the integral is the weight of the back end
// (docs/numerics.md, section 5), in closed form. With depths from 1e-8 to 1e7, boundary layers are
// as thin as 1e-7 of the piece.
TEST(EmissionIntegral, LinearPiecesEqualTheClosedForm) {
    for (const double p : {0.0, 1e-8, 1e-3, 0.5, 3.0, 20.0, 1e3, 1e5, 1e7}) {
        for (const double q : {0.0, 1e-8, 1e-2, 1.0, 7.0, 50.0, 1e4, 1e7}) {
            const EmissionPiece piece{{{0, 1, 0, 0}}, {{p, q - p, 0, 0}}};
            const EmissionIntegral found = integrate_emission(piece, 1e-13, 1e-13);
            const double expected = piece_weights(p, q).back;
            // The allowed error is 2e-13. Rounding: depth(t) near the front has an error of 1e-16
            // of p.
            EXPECT_NEAR(found.value, expected, 5e-13) << "p " << p << " q " << q;
            EXPECT_LE(found.error, 3e-13) << "p " << p << " q " << q;
        }
    }
}

// For a cubic position and constant extinction s, the integrals of t^n s exp(-s t) follow by
// recurrence: I_n = n / s I_(n-1) - exp(-s), I_0 = 1 - exp(-s).
TEST(EmissionIntegral, CubicPositionsEqualTheClosedForm) {
    for (const double s : {2.0, 10.0, 300.0, 1e5, 1e7}) {
        const EmissionPiece piece{{{0.25, 1.5, -2.0, 1.0}}, {{s, 0, 0, 0}}};
        double moment = -std::expm1(-s), expected = 0.25 * moment;
        for (std::size_t n = 1; n < 4; ++n) {
            moment = static_cast<double>(n) / s * moment - std::exp(-s);
            expected += piece.position.c[n] * moment;
        }
        const EmissionIntegral found = integrate_emission(piece, 1e-13, 1e-13);
        EXPECT_NEAR(found.value, expected, 5e-13) << s;  // as in LinearPiecesEqualTheClosedForm
    }
}

TEST(EmissionIntegral, EstimateCoversTheErrorAndKeepsTheTolerance) {
    Random random(5);
    for (int i = 0; i < 3000; ++i) {
        const double strength = std::pow(10, random.uniform(-3, 7));
        const EmissionPiece piece = random_piece(random, strength);
        const EmissionIntegral exact = integrate_emission(piece, 1e-13, 1e-13);
        for (const double tolerance : {1e-2, 1e-4, 1e-6, 1e-9}) {
            const EmissionIntegral found = integrate_emission(piece, tolerance / 2, tolerance / 2);
            EXPECT_LE(found.error, tolerance) << strength;
            EXPECT_LE(std::abs(found.value - exact.value), found.error + exact.error + 1e-14)
                << strength << " tolerance " << tolerance;
        }
    }
}

void add(const EmissionPiece& piece, double before, double allowed_by_length, double color_span,
         PieceBatch& batch) {
    batch.make_room(batch.count + 1);
    for (std::size_t power = 0; power < 4; ++power) {
        batch.position[power][batch.count] = piece.position.c[power];
        batch.extinction[power][batch.count] = piece.extinction.c[power];
    }
    batch.depth[batch.count] = piece.depth(1);
    batch.before[batch.count] = before;
    batch.error_of_length[batch.count] = allowed_by_length;
    batch.color_span[batch.count] = color_span;
    ++batch.count;
}

// Integrates vectors of pieces, from nearly transparent ones to boundary layers, which are
// bisected. Errors must be within the estimates, and estimates within the tolerance.
TEST(PieceBatch, PiecesEqualThoseIntegratedOneByOne) {
    Random random(7);
    for (const double tolerance : {1e-3, 1e-6, 1e-12}) {
        for (std::size_t count = 1; count <= 33; ++count) {
            PieceBatch batch;
            batch.error_of_opacity = tolerance;
            for (std::size_t i = 0; i < count; ++i) {
                const EmissionPiece piece =
                    random_piece(random, std::pow(10, random.uniform(-9, 6)));
                add(piece, random.uniform(0, 9), tolerance, random.uniform(), batch);
            }
            // Deep pieces behind the batch's end must be left alone.
            const std::size_t given = batch.count;
            for (int i = 0; i < 7; ++i) add(random_piece(random, 1e6), 0, 0, 1, batch);
            batch.count = given;
            const std::vector<double> before_all = batch.value;
            integrate_emission(batch);
            const std::size_t padded = (given + 7) / 8 * 8;
            for (std::size_t i = padded; i < given + 7; ++i)
                EXPECT_EQ(batch.value[i], before_all[i]);
            for (std::size_t i = 0; i < count; ++i) {
                const double transmittance = std::exp(-batch.before[i]);
                const double opacity = -std::expm1(-batch.depth[i]);
                const EmissionIntegral exact = integrate_emission(batch.piece(i), 1e-13, 1e-13);
                // Exp() and Expm1() of Highway are good to 4 units in the last place.
                EXPECT_NEAR(batch.transmittance[i], transmittance, 1e-15 * transmittance);
                EXPECT_NEAR(batch.opacity[i], opacity, 1e-15 * opacity);
                EXPECT_LE(std::abs(batch.value[i] - exact.value),
                          batch.error[i] + exact.error + 1e-14);
                const double allowed = tolerance * (1 + transmittance * opacity) /
                                       (transmittance * batch.color_span[i]);
                EXPECT_LE(batch.error[i], allowed + 1e-15 * batch.depth[i]);
            }
        }
    }
}

}  // namespace
}  // namespace lamina
