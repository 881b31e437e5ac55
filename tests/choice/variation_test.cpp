// SPDX-License-Identifier: Apache-2.0
#include "choice/variation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/vec3.hpp>

#include "support/split_box.h"
#include "support/stored_volume.h"
#include "support/volume_of.h"

namespace lamina {
namespace {

constexpr std::size_t some_bins = 32;

Variation measured_of(const Volume& volume, double lo, double hi) {
    return variation_of(volume, {{0, 0, 0}, volume.grid().size}, {lo, hi},
                        Variation(lo, hi, some_bins));
}

// A linear field has one gradient, which differences give exactly, whatever the spacings.
TEST(Variation, OfALinearFieldIsItsGradientAndCoherent) {
    Grid grid = test::grid_of({30, 20, 25}, Centering::node);
    grid.step = {glm::dvec3(.5, 0, 0), glm::dvec3(0, 2, 0), glm::dvec3(0, 0, 3)};
    const Volume volume =
        test::volume_of(grid, [](double i, double j, double k) { return 2 * i + 4 * j + 9 * k; });
    const Variation found = measured_of(volume, 0, 400);
    const double gradient = std::sqrt(4. * 4 + 2. * 2 + 3. * 3);  // per world unit
    for (const double value : {60., 150., 250.}) {
        EXPECT_NEAR(found.slope(found.bin_of(value)), gradient, 1e-12) << value;
        EXPECT_EQ(found.coherence(found.bin_of(value)), 1) << value;
    }
}

// The gradient of a distance has the length 1 but at its kinks; three independent normal
// components have a length whose mean squared is 8 / (3 pi) of its mean square.
TEST(Variation, IsEvenForADistanceAlone) {
    const Grid grid = test::grid_of({40, 40, 40}, Centering::node);
    const auto distance = [](double i, double j, double k) {
        return glm::length(glm::dvec3(i, j, k) - 19.5) - 12;
    };
    EXPECT_GT(measured_of(test::volume_of(grid, distance), -12, 25).evenness(), .98);
    const Volume waves = test::volume_of(grid, [](double i, double j, double k) {
        return std::sin(.31 * i + .2 * j) + std::sin(.37 * j - .17 * k) +
               std::sin(.29 * k + .1 * i);
    });
    EXPECT_LT(measured_of(waves, -3, 3).evenness(), .9);
    EXPECT_EQ(measured_of(test::volume_of(grid, [](double, double, double) { return 1; }), 0, 2)
                  .evenness(),
              0);
}

TEST(Variation, OfATetIsTheGradientOfItsLinearField) {
    const SceneMesh mesh = scene_mesh(
        Scene(), test::kuhn_box({4, 4, 4}, [](const glm::dvec3& p) { return 3 * p.x - 4 * p.z; }));
    const Variation found = variation_of(mesh, {-16, 12}, Variation(-16, 12, some_bins));
    EXPECT_NEAR(found.slope(found.bin_of(0)), 5, 1e-12);
    EXPECT_EQ(found.coherence(found.bin_of(0)), 1);
}

// Half the difference of two independent samples of variance v has the variance v/2, the second
// difference 6 v: so few places of white noise go on rising. They are most at middle values, from
// which second differences are the smallest.
TEST(Variation, OfWhiteNoiseIsIncoherent) {
    const Volume volume = test::noise(test::grid_of({40, 40, 40}, Centering::node), 5);
    const Variation found = measured_of(volume, 0, 255);
    for (const double value : {20., 128., 230.})
        EXPECT_LT(found.coherence(found.bin_of(value)), .45) << value;
}

TEST(Variation, LeavesOutPlacesBesideValuesThatWereNotMeasured) {
    const Volume volume =
        test::volume_of(test::grid_of({20, 20, 20}, Centering::node),
                        [](double i, double, double) { return i < 10 ? -9999 : i; });
    const Variation found = measured_of(volume, 10, 19);
    for (std::size_t bin = 0; bin < some_bins; ++bin) {
        if (found.weight(bin) == 0) continue;
        EXPECT_NEAR(found.slope(bin), 1, 1e-12) << bin;
    }
    EXPECT_EQ(found.weight(found.bin_of(10)), 0);  // their neighbours at 9 are padding
}

TEST(Variation, DoesNotDependOnWhereTheSamplesAreKept) {
    const Volume volume = test::noise(test::grid_of({70, 90, 33}, Centering::node), 2);
    const Variation here = measured_of(volume, 0, 255);
    const Variation there = measured_of(test::stored(volume), 0, 255);
    for (std::size_t bin = 0; bin < some_bins; ++bin) {
        EXPECT_EQ(here.weight(bin), there.weight(bin));
        EXPECT_EQ(here.slope(bin), there.slope(bin));
        EXPECT_EQ(here.coherence(bin), there.coherence(bin));
    }
}

TEST(Variation, IsMirroredWithTheValues) {
    Variation one(0, 10, 10);
    one.add(2.5, 3, 7, true);
    const Variation other = one.negated();
    EXPECT_EQ(other.weight(other.bin_of(-2.5)), 3);
    EXPECT_EQ(other.slope(other.bin_of(-2.5)), 7);
    EXPECT_NEAR(other.value(other.bin_of(-2.5)), -2.5, 1e-12);
}

}  // namespace
}  // namespace lamina
