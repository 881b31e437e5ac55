// SPDX-License-Identifier: Apache-2.0
#include "meshing/interpolation_error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <random>

#include "meshing/trilinear_field.h"
#include "support/volume_of.h"

namespace lamina {
namespace {

using namespace test;
using Corners = std::array<glm::dvec3, 4>;

Grid cube(std::int64_t n) {
    return grid_of({n, n, n}, Centering::node);
}

// A volume with its InterpolationError.
struct Measured {
    Volume volume;
    TrilinearField field{volume};
    CellRanges ranges{field};

    TetError measure(const Corners& corners, double tolerance, ErrorGoal goal,
                     const TransferFunction* transfer_function = nullptr) const {
        std::array<double, 4> values{};
        for (std::size_t i = 0; i < 4; ++i) values[i] = field.at(corners[i]);
        return InterpolationError(field, ranges, transfer_function)
            .measure(corners, values, tolerance, goal);
    }
};

// Visits the points of a tet whose barycentric coordinates are multiples of 1/n.
void for_each_point(const Corners& corners, int n,
                    const std::function<void(const glm::dvec3&, const std::array<double, 4>&)>& f) {
    for (int a = 0; a <= n; ++a)
        for (int b = 0; a + b <= n; ++b)
            for (int c = 0; a + b + c <= n; ++c) {
                const double s = 1.0 / n;
                const std::array<double, 4> w{a * s, b * s, c * s, (n - a - b - c) * s};
                f(w[0] * corners[0] + w[1] * corners[1] + w[2] * corners[2] + w[3] * corners[3], w);
            }
}

double brute_force(const Measured& measured, const Corners& corners, int n,
                   const TransferFunction* transfer_function = nullptr) {
    double largest = 0;
    for_each_point(corners, n, [&](const glm::dvec3& place, const std::array<double, 4>& w) {
        const double field = trilinear_at(measured.volume, place);
        double linear = 0;
        for (std::size_t i = 0; i < 4; ++i) linear += w[i] * measured.field.at(corners[i]);
        const auto [lo, hi] = std::minmax(field, linear);
        if (transfer_function && transfer_function->transparent(lo, hi)) return;
        largest = std::max(largest, hi - lo);
    });
    return largest;
}

Corners random_tet(std::mt19937& random, double size, double extent) {
    std::uniform_real_distribution<double> uniform(0, 1);
    glm::dvec3 first(0);
    for (int axis = 0; axis < 3; ++axis) first[axis] = uniform(random) * (size - extent);
    Corners corners;
    for (glm::dvec3& corner : corners) {
        corner = first;
        for (int axis = 0; axis < 3; ++axis) corner[axis] += uniform(random) * extent;
    }
    return corners;
}

TEST(CellPieces, ClippingKeepsTheVolumeInside) {
    std::mt19937 random(1);
    const auto volume_of_piece = [](const CellPiece& piece) {
        const auto& p = piece.corners;
        return std::abs(glm::dot(glm::cross(p[1] - p[0], p[2] - p[0]), p[3] - p[0])) / 6;
    };
    // The cells -1..2 along each axis contain all of the tet: the parts of it add up to its volume.
    for (int turn = 0; turn < 50; ++turn) {
        Corners corners = random_tet(random, 3, 3);
        if (turn % 2 == 0) corners[0] = glm::round(corners[0]);  // planes through corners
        if (turn % 4 == 0) corners[1] = glm::round(corners[1]);
        const CellPiece whole{corners, {0, 1, 2, 3}};
        double sum = 0;
        std::vector<CellPiece> pieces, spare;
        for (int cell = 0; cell < 27; ++cell) {
            CellPiece shifted = whole;
            for (auto& p : shifted.corners) p -= glm::dvec3(cell % 3, cell / 3 % 3, cell / 9);
            pieces.assign(1, shifted);
            clip_to_cell(pieces, spare);
            for (const CellPiece& piece : pieces) {
                sum += volume_of_piece(piece);
                for (const glm::dvec3& p : piece.corners) {
                    EXPECT_TRUE(p.x >= -1e-15 && p.x <= 1 + 1e-15 && p.y >= -1e-15 &&
                                p.y <= 1 + 1e-15 && p.z >= -1e-15 && p.z <= 1 + 1e-15);
                }
            }
        }
        // Rounding: some hundred pieces with coordinates near 1.
        EXPECT_NEAR(sum, volume_of_piece(whole), 1e-13);
    }
}

TEST(CellPieces, BernsteinFormIsTheDifference) {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> uniform(-1, 1);
    std::array<double, 8> corners{};
    for (double& corner : corners) corner = uniform(random);
    const TrilinearPolynomial polynomial(corners);
    CellPiece piece{random_tet(random, 1, 1), {0.3, -0.2, 0.9, 0.1}};
    const BernsteinCubic cubic(polynomial, piece);
    // The Bernstein polynomials of degree 3: 1, 3 or 6 times the product of three weights.
    for_each_point(piece.corners, 5, [&](const glm::dvec3& p, const std::array<double, 4>& w) {
        double trilinear = 0, difference = 0;
        const auto add = [&](std::size_t i, double weight) {
            trilinear += weight * cubic.trilinear[i];
            difference += weight * cubic.difference[i];
        };
        for (std::size_t i = 0; i < 4; ++i) {
            add(i, w[i] * w[i] * w[i]);
            const auto& [a, b, c] = face_corners[i];
            add(16 + i, 6 * w[a] * w[b] * w[c]);
        }
        for (std::size_t i = 0; i < 6; ++i) {
            const auto& [a, b] = tet_edges[i];
            add(4 + 2 * i, 3 * w[a] * w[a] * w[b]);
            add(5 + 2 * i, 3 * w[a] * w[b] * w[b]);
        }
        double linear = 0;
        for (std::size_t i = 0; i < 4; ++i) linear += w[i] * piece.values[i];
        EXPECT_NEAR(trilinear, polynomial.at(p), 1e-14);  // twenty terms below 1
        EXPECT_NEAR(difference, polynomial.at(p) - linear, 1e-14);
    });
}

TEST(CellRanges, CoverTheirBlocks) {
    const Volume volume = noise(grid_of({12, 7, 5}, Centering::cell), 3);
    const TrilinearField field(volume);
    const CellRanges ranges(field);
    ASSERT_EQ(ranges.levels(), 4);  // 13 x 8 x 6 cells
    for (int level = 1; level <= ranges.levels(); ++level) {
        for (std::int32_t x = 0; x < 13; ++x)
            for (std::int32_t y = 0; y < 8; ++y)
                for (std::int32_t z = 0; z < 6; ++z) {
                    const ValueRange range =
                        ranges.of_block(level, {x >> level, y >> level, z >> level});
                    for (const double value : field.corners({x, y, z})) {
                        ASSERT_GE(value, range.lo);
                        ASSERT_LE(value, range.hi);
                    }
                }
    }
    EXPECT_EQ(ranges.of_block(4, {0, 0, 0}).lo, field.range().lo);
    EXPECT_EQ(ranges.of_block(4, {0, 0, 0}).hi, field.range().hi);
}

// The field is f = xy, on the tet at the corner: the linear function is 0, and xy is largest in the
// middle of the edge from (1, 0, 0) to (0, 1, 0).
TEST(InterpolationError, MatchesTheClosedFormInOneCell) {
    const Measured measured{volume_of(cube(2), [](double i, double j, double) { return i * j; })};
    const Corners corners{glm::dvec3{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const TetError error = measured.measure(corners, 0.01, ErrorGoal::bound);
    EXPECT_GE(error.bound, 0.25);
    EXPECT_LE(error.bound, 0.25 / 0.98 + 1e-15);
    EXPECT_LE(error.found, 0.25);
    EXPECT_GE(error.found, 0.98 * error.bound - 1e-15);
    EXPECT_NEAR(error.place.x * error.place.y, error.found, 1e-15);
}

// The field is xyz on the tet (0,0,0), (1,1,0), (1,0,1), (1,1,1), on which the linear function is
// the last corner's weight.
TEST(InterpolationError, IsDecidedWithinAFewPercentOfTheTolerance) {
    const Measured measured{
        volume_of(cube(2), [](double i, double j, double k) { return i * j * k; })};
    const Corners corners{glm::dvec3{0, 0, 0}, {1, 1, 0}, {1, 0, 1}, {1, 1, 1}};
    const double truth = brute_force(measured, corners, 60);
    const TetError above = measured.measure(corners, 1.01 * truth, ErrorGoal::decide);
    const TetError below = measured.measure(corners, 0.99 * truth, ErrorGoal::decide);
    EXPECT_LE(below.found, truth * 1.001);  // the brute force misses the maximum by (1/60)^2
    EXPECT_TRUE(std::isinf(below.bound));
    EXPECT_GE(below.found, 0.97 * truth);
    // An error 1 % below the tolerance may be decided either way (0.98), but the bound must hold.
    EXPECT_GE(above.bound, truth);
    const TetError clear = measured.measure(corners, 1.05 * truth, ErrorGoal::decide);
    EXPECT_LE(clear.bound, 1.05 * truth);
    EXPECT_GE(clear.bound, truth);
}

struct Case {
    std::string name;
    Volume volume;
};

// For noise, steps and constant regions the bound holds at every sampled point, and is near the
// largest difference found.
TEST(InterpolationError, BoundsTheErrorFoundByBruteForce) {
    std::vector<Case> cases{
        {"noise", noise(cube(9), 4)},
        {"cell", noise(grid_of({9, 9, 9}, Centering::cell), 5)},
        {"step",
         volume_of(cube(9), [](double i, double j, double k) { return i + j + k > 11 ? 200 : 3; })},
        {"smooth", volume_of(cube(9), [](double i, double j, double k) {
             return 100 * std::sin(i / 2) * std::cos(j / 3) + 5 * k;
         })}};
    std::mt19937 random(6);
    for (Case& test : cases) {
        const Measured measured{test.volume};
        for (int turn = 0; turn < 60; ++turn) {
            const Corners corners = random_tet(random, 8,
                                               turn % 3 == 0   ? 8
                                               : turn % 3 == 1 ? 2
                                                               : 0.6);
            const double sampled = brute_force(measured, corners, 24);
            const double range = measured.field.range().hi - measured.field.range().lo;
            const double rounding = 1e-12 * range;
            const TetError exact = measured.measure(corners, 1e-3 * range, ErrorGoal::bound);
            EXPECT_GE(exact.bound, sampled - rounding) << test.name;
            EXPECT_TRUE(exact.bound <= 1e-3 * range || exact.found >= 0.98 * exact.bound - rounding)
                << test.name << " " << exact.bound << " " << exact.found;
            EXPECT_LE(exact.found, exact.bound);
            // At `place`, which is in the tet, the difference is `found`.
            if (exact.found > 0) {
                double linear = 0;
                const glm::dvec3 b = corners[1] - corners[0], c = corners[2] - corners[0];
                const glm::dvec3 d = corners[3] - corners[0], at = exact.place - corners[0];
                const double volume = glm::dot(glm::cross(b, c), d);
                std::array<double, 4> w{0, glm::dot(glm::cross(c, d), at) / volume,
                                        glm::dot(glm::cross(d, b), at) / volume,
                                        glm::dot(glm::cross(b, c), at) / volume};
                w[0] = 1 - w[1] - w[2] - w[3];
                for (std::size_t i = 0; i < 4; ++i) {
                    EXPECT_GE(w[i], -1e-9);
                    linear += w[i] * measured.field.at(corners[i]);
                }
                EXPECT_NEAR(std::abs(trilinear_at(measured.volume, exact.place) - linear),
                            exact.found, 1e-8 * range);
            }
            for (const double share : {0.5, 0.9, 1.1, 2.0}) {
                const double tolerance = std::max(share * exact.bound, 1e-3 * range);
                const TetError decided = measured.measure(corners, tolerance, ErrorGoal::decide);
                if (decided.bound <= tolerance) {
                    EXPECT_GE(decided.bound, sampled - rounding);
                } else {
                    EXPECT_TRUE(std::isinf(decided.bound));
                    EXPECT_GT(decided.found, 0.98 * tolerance);
                    EXPECT_LE(decided.found, exact.bound + rounding);
                }
            }
        }
    }
}

// Integer samples make differences that equal the tolerance exactly, all along edges.
TEST(InterpolationError, IsDecidedEvenIfItEqualsTheTolerance) {
    const Measured measured{volume_of(cube(4), [](double i, double, double) { return i == 1; })};
    const Corners corners{glm::dvec3{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 0, 2}};
    const TetError error = measured.measure(corners, 1, ErrorGoal::decide);
    EXPECT_TRUE(error.bound == 1 || (error.found >= 0.98 && error.found <= 1));
}

TEST(InterpolationError, IsBoundedInThinTetsToo) {
    const Measured measured{noise(cube(6), 8)};
    std::mt19937 random(9);
    for (const double thickness : {1e-3, 1e-6, 1e-9, 1e-13}) {
        for (int turn = 0; turn < 10; ++turn) {
            Corners corners = random_tet(random, 5, 5);
            corners[3] = 0.2 * corners[0] + 0.3 * corners[1] + 0.5 * corners[2];
            corners[3].z += corners[3].z > 2.5 ? -thickness : thickness;
            const TetError error = measured.measure(corners, 0.01, ErrorGoal::bound);
            EXPECT_GE(error.bound, brute_force(measured, corners, 30) - 1e-10);
            EXPECT_LE(error.bound, 256);
        }
    }
    const Corners flat{glm::dvec3{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {1, 1, 0}};
    EXPECT_EQ(measured.measure(flat, 0.01, ErrorGoal::bound).bound, 0);
}

TEST(InterpolationError, InvisibleDifferencesDoNotCount) {
    const Measured measured{noise(cube(9), 10)};
    // Only 100..150 shows. A difference counts in full if the values between the two functions
    // touch this range.
    const auto transfer_function = TransferFunction::linear(
        {{100, {{1, 1, 1}, 0}}, {125, {{1, 1, 1}, 5}}, {150, {{1, 1, 1}, 0}}});
    const auto nothing = TransferFunction::linear({{0, {{1, 1, 1}, 0}}});
    std::mt19937 random(11);
    for (int turn = 0; turn < 40; ++turn) {
        const Corners corners = random_tet(random, 8, turn % 2 == 0 ? 4 : 0.7);
        const double sampled = brute_force(measured, corners, 24, &transfer_function);
        const TetError error = measured.measure(corners, 0.3, ErrorGoal::bound, &transfer_function);
        EXPECT_GE(error.bound, sampled - 1e-10);
        EXPECT_LE(error.bound, measured.measure(corners, 0.3, ErrorGoal::bound).bound / 0.98);
        EXPECT_EQ(measured.measure(corners, 0.3, ErrorGoal::bound, &nothing).found, 0);
        EXPECT_LE(measured.measure(corners, 0.3, ErrorGoal::bound, &nothing).bound, 0.3);
    }
}

TEST(InterpolationError, LargestIsOverAllTets) {
    const Measured measured{volume_of(cube(2), [](double i, double j, double) { return i * j; })};
    const std::vector<glm::dvec3> points{{0, 0, 0}, {1, 0, 0},   {0, 1, 0},
                                         {0, 0, 1}, {0.1, 0, 0}, {0, 0.1, 0}};
    const std::vector<double> values(6, 0.0);
    const InterpolationError error(measured.field, measured.ranges, nullptr);
    EXPECT_NEAR(error.largest(points, values, std::vector<Tet>{{0, 4, 5, 3}}, 1e-5), 0.0025, 1e-4);
    const std::vector<Tet> both{{0, 4, 5, 3}, {0, 1, 2, 3}};
    EXPECT_NEAR(error.largest(points, values, both, 1e-5), 0.25, 0.01);
    EXPECT_EQ(error.largest(points, values, {}, 1e-5), 0);
}

}  // namespace
}  // namespace lamina
