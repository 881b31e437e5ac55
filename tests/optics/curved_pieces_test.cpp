// SPDX-License-Identifier: Apache-2.0
#include "optics/pieces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "optics/opacity.h"

namespace lamina {
namespace {

const glm::dvec3 dark{.1, 0, .3}, light{1, .8, .6};

double extinction_at(const CurvedPiece& piece, double value) {
    const double u = (value - piece.from) / (piece.to - piece.from);
    const double line = (1 - u) * piece.at_from.extinction + u * piece.at_to.extinction;
    return line + u * (1 - u) * (piece.bend[0] + u * piece.bend[1]);
}

// Expects that pieces meet and are within curve_tolerance of the function. `slope` is the
// extinction that the function's points approximate; the pieces must be within the tolerance of it,
// too.
template <typename Slope>
void expect_followed(const std::vector<CurvedPiece>& pieces, const TransferFunction& function,
                     const Slope& slope) {
    constexpr int places = 500;
    const double lo = pieces.front().from, hi = pieces.back().to;
    auto piece = pieces.begin();
    for (int i = 0; i < places; ++i) {
        const double value = lo + (hi - lo) * i / places;
        while (value > piece->to) {
            EXPECT_EQ(piece->to, (piece + 1)->from);
            EXPECT_EQ(piece->at_to, (piece + 1)->at_from);
            ++piece;
        }
        const double wanted = function.at(value).extinction;
        // Curves are compared with straight pieces at some places only, and may be a tenth farther
        // away between them.
        EXPECT_NEAR(extinction_at(*piece, value), wanted, 1.1 * curve_tolerance * wanted) << value;
        const double exact = slope(value);
        EXPECT_NEAR(extinction_at(*piece, value), exact, curve_tolerance * exact) << value;
    }
}

TEST(CurvedPieces, FollowSlopesOfOpacity) {
    struct Slope {
        double from, to;
        std::size_t most;  // pieces; three cubics or a fifth of the straight pieces
    };
    for (const Slope& slope :
         {Slope{0, .9, 6}, Slope{0, .5, 3}, Slope{.8, .1, 5}, Slope{0, .999, 11}}) {
        const auto function =
            TransferFunction::linear_opacity({{10, dark, slope.from}, {60, light, slope.to}}, 2.5);
        const auto straight = pieces_between(function, 10, 60, false);
        const auto pieces = pieces_between(function, 10, 60, true);
        EXPECT_EQ(straight.size() + 1, function.knots().size());
        EXPECT_LE(pieces.size(), slope.most) << slope.from << " to " << slope.to;
        expect_followed(pieces, function, [&](double value) {
            const double share = (value - 10) / 50;
            return -std::log1p(-(slope.from + share * (slope.to - slope.from))) / 2.5;
        });
    }
}

TEST(CurvedPieces, ASlopeToOneEndsAtTheSteepestDepth) {
    const auto function =
        TransferFunction::linear_opacity({{0, dark, 0}, {1, dark, 1}, {2, dark, 1}}, 1);
    const auto pieces = pieces_between(function, 0, 1, true);
    EXPECT_LE(pieces.size(), 24u);
    EXPECT_EQ(pieces.back().at_to.extinction, steepest_optical_depth);
    expect_followed(pieces, function, [](double value) {
        return value < 1 ? std::min(-std::log1p(-value), steepest_optical_depth)
                         : steepest_optical_depth;
    });
}

TEST(CurvedPieces, ACutRangeIsFollowedFromItsEnds) {
    const auto function = TransferFunction::linear_opacity({{0, dark, 0}, {1, light, .95}}, 1);
    const auto pieces = pieces_between(function, .2173, .8419, true);
    EXPECT_EQ(pieces.front().from, .2173);
    EXPECT_EQ(pieces.back().to, .8419);
    EXPECT_LE(pieces.size(), 5u);
    expect_followed(pieces, function, [](double value) { return -std::log1p(-.95 * value); });
}

// Points given by extinction mean straight lines, even if these are near a curve.
TEST(CurvedPieces, OnlySmoothPointsAreFollowed) {
    for (const bool smooth : {false, true}) {
        std::vector<TransferKnot> knots;
        for (int i = 0; i <= 100; ++i)
            knots.push_back({i / 100.0, {dark, std::exp(-i / 30.0)}, smooth});
        const auto function = TransferFunction::linear(knots);
        const auto pieces = pieces_between(function, 0, 1, true);
        if (smooth) {
            EXPECT_LE(pieces.size(), 5u);
            expect_followed(pieces, function,
                            [](double value) { return std::exp(-value * 100 / 30); });
        } else {
            EXPECT_EQ(pieces.size(), 100u);
            for (const CurvedPiece& piece : pieces) EXPECT_TRUE(piece.bend[0] == 0);
        }
    }
}

// Steps, bends of colour and transparent intervals stay as they are.
TEST(CurvedPieces, EndAtCorners) {
    const auto smooth = [](double value, const glm::dvec3& color, double extinction) {
        return TransferKnot{value, {color, extinction}, true};
    };
    const auto step = TransferFunction::linear(
        {smooth(0, dark, 1), smooth(1, dark, 2), smooth(1, dark, 2.001), smooth(2, dark, 3)});
    EXPECT_EQ(pieces_between(step, 0, 2, true).size(), 2u);
    const auto color =
        TransferFunction::linear({smooth(0, dark, 1), smooth(1, light, 2), smooth(2, dark, 3.001)});
    EXPECT_EQ(pieces_between(color, 0, 2, true).size(), 2u);
    const auto nothing = TransferFunction::linear(
        {smooth(0, dark, 0), smooth(1, dark, 0), smooth(2, dark, 1), smooth(3, dark, 2.001)});
    const auto pieces = pieces_between(nothing, 0, 3, true);
    ASSERT_EQ(pieces.size(), 2u);
    EXPECT_EQ(pieces[0].to, 1);
    EXPECT_EQ(pieces[0].at_to.extinction, 0);
    EXPECT_TRUE(pieces[0].bend[0] == 0 && pieces[0].bend[1] == 0);
}

}  // namespace
}  // namespace lamina
