// SPDX-License-Identifier: Apache-2.0
#include "reference/cells.h"

#include <gtest/gtest.h>

#include "fixtures.h"

namespace lamina {
namespace {

using namespace reference_test;

glm::dvec3 at(const GradientAlong& gradient, double t) {
    return {gradient[0](t), gradient[1](t), gradient[2](t)};
}

// Returns the gradient in a cell at one place, in coordinates of the cell.
template <typename Sample>
glm::dvec3 gradient_at(const Grid& grid, const std::vector<Sample>& samples, const CellIndex& cell,
                       const glm::dvec3& place) {
    return at(GradientSamples(grid, samples.data()).along(cell, place, glm::dvec3(0)), 0);
}

// Returns a turned and mirrored grid with three different spacings, whose lengths are exact.
Grid turned_grid(const std::array<std::int64_t, 3>& size) {
    Grid grid;
    grid.size = size;
    grid.centering.fill(Centering::cell);
    grid.origin = {3, -5, 7};
    grid.step = {glm::dvec3(2, 1, 2) * .25, glm::dvec3(-2, 2, 1) * .5, glm::dvec3(1, 2, -2)};
    return grid;
}

template <typename Field>
std::vector<float> sampled(const Grid& grid, const Field& field) {
    std::vector<float> samples;
    for (int k = 0; k < grid.size[2]; ++k)
        for (int j = 0; j < grid.size[1]; ++j)
            for (int i = 0; i < grid.size[0]; ++i)
                samples.push_back(static_cast<float>(field(grid.to_world({i, j, k}))));
    return samples;
}

// A linear field has its gradient everywhere, also at the border and beyond it, where the border
// sample repeats. Values are exact in float32, and each axis contributes a few roundings of 1e-16
// of the gradient.
TEST(GradientSamples, MatchTheGradientOfALinearField) {
    const Grid grid = turned_grid({4, 3, 2});
    const glm::dvec3 g(1.5, -4, 8);
    const std::vector<float> samples =
        sampled(grid, [&](const glm::dvec3& p) { return 2 + glm::dot(g, p); });
    for (std::int64_t z = -1; z < 2; ++z)
        for (std::int64_t y = -1; y < 3; ++y)
            for (std::int64_t x = -1; x < 4; ++x)
                EXPECT_LE(glm::distance(gradient_at(grid, samples, {x, y, z}, {.3, .9, .5}), g),
                          2e-14);
}

// The field is x^2 at 0, 1, 2, 3. Gradients are one-sided at the ends (1 and 5), central inside (2
// and 4), and linear between samples.
TEST(GradientSamples, AreDifferencesOfNeighbors) {
    const Grid grid = make_grid({4, 1, 1}, Centering::cell, {.5, 3, 3});
    const std::vector<float> samples{0, 1, 4, 9};
    const auto x = [&](std::int64_t cell, double place) {
        const glm::dvec3 g = gradient_at(grid, samples, {cell, 0, 0}, {place, .5, .5});
        EXPECT_EQ(g.y, 0);  // one sample
        EXPECT_EQ(g.z, 0);
        return g.x * .5;
    };
    EXPECT_EQ(x(0, 0), 1);
    EXPECT_EQ(x(0, .5), 1.5);
    EXPECT_EQ(x(1, 0), 2);
    EXPECT_EQ(x(2, 0), 4);
    EXPECT_EQ(x(2, 1), 5);
    EXPECT_EQ(x(-1, .75), 1);  // the outer half voxels
    EXPECT_EQ(x(3, .25), 5);
}

TEST(GradientSamples, AreOneSidedBesideNonFiniteSamples) {
    const Grid grid = make_grid({6, 1, 1}, Centering::cell);
    for (const float hole : {NAN, INFINITY, -INFINITY}) {
        const std::vector<float> samples{0, 1, 4, hole, 5, hole};
        const auto x = [&](std::int64_t index) {
            return gradient_at(grid, samples, {index, 0, 0}, glm::dvec3(0)).x;
        };
        EXPECT_EQ(gradient_at(grid, samples, {1, 0, 0}, glm::dvec3(.0, .5, .5)).x, 2);
        EXPECT_EQ(gradient_at(grid, samples, {1, 0, 0}, glm::dvec3(1, .5, .5)).x, 3);
        // A number between two NaNs has no gradient.
        EXPECT_EQ(gradient_at(grid, samples, {3, 0, 0}, glm::dvec3(1, .5, .5)).x, 0);
        EXPECT_EQ(x(0), 1);
    }
}

TEST(GradientSamples, DoNotWrapForIntegers) {
    const Grid grid = make_grid({2, 2, 2}, Centering::node);
    const std::vector<std::uint8_t> samples{255, 0, 0, 0, 0, 0, 0, 0};
    EXPECT_EQ(gradient_at(grid, samples, {0, 0, 0}, glm::dvec3(0)), glm::dvec3(-255));
    EXPECT_EQ(gradient_at(grid, samples, {0, 0, 0}, {1, 0, 0}), glm::dvec3(-255, 0, 0));
}

}  // namespace
}  // namespace lamina
