// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "lamina/session.h"
#include "support/expect_error.h"
#include "support/split_box.h"
#include "support/volume_of.h"

namespace lamina {
namespace {

const SessionOptions on_cpu{ContextChoice::cpu, 0};

Scene automatic_scene() {
    Scene scene;
    scene.transfer_function = automatic;
    scene.camera = automatic;
    return scene;
}

TEST(Histogram, CountsTheSamplesOfAVolume) {
    const Volume volume = test::volume_of<std::uint8_t>(
        test::grid_of({4, 4, 4}, Centering::node),
        [](double i, double j, double) { return j == 0 ? 40 : 10 * i; });
    Session session(automatic_scene(), volume, on_cpu);
    // The samples are whole numbers from 0 to 40: 5 intervals of 9 numbers each.
    const ValueHistogram histogram = session.histogram(5);
    EXPECT_EQ(histogram.lo, -.5);
    EXPECT_EQ(histogram.hi, 44.5);
    // The intervals contain 0, 10, 20, 30 and 40; each of the first four values is in 3 of 16
    // columns. Counts of 64 samples are exact.
    EXPECT_EQ(histogram.shares, (std::vector<double>{3. / 16, 3. / 16, 3. / 16, 3. / 16, 4. / 16}));
    EXPECT_EQ(session.histogram(1000).shares.size(), 41u);
    expect_error([&] { session.histogram(0); }, {"found 0"});
}

TEST(Histogram, LeavesOutNonFiniteSamples) {
    constexpr float none = std::numeric_limits<float>::quiet_NaN();
    Scene scene = automatic_scene();
    scene.nan = NanPolicy::transparent;
    Session session(scene,
                    test::volume_of(test::grid_of({4, 2, 2}, Centering::node),
                                    [](double i, double, double) {
                                        return i == 0 ? none : static_cast<float>(i);
                                    }),
                    on_cpu);
    const ValueHistogram histogram = session.histogram(2);
    EXPECT_EQ(histogram.lo, 1);
    EXPECT_EQ(histogram.hi, 3);
    ASSERT_EQ(histogram.shares.size(), 2u);
    // A third of the samples is 1; the value 2 is counted in the upper interval. Tolerance:
    // rounding of one division.
    EXPECT_NEAR(histogram.shares[0], 1. / 3, 1e-16);
    EXPECT_NEAR(histogram.shares[1], 2. / 3, 2e-16);
}

// The field is x, so each of the four intervals gets a fourth of the volume.
TEST(Histogram, WeighsTheTetsOfAMeshByVolume) {
    Scene scene = automatic_scene();
    scene.method = Method::project;
    Session session(scene, test::kuhn_box({4, 2, 2}, [](const glm::dvec3& at) { return at.x; }),
                    on_cpu);
    const ValueHistogram histogram = session.histogram(4);
    ASSERT_EQ(histogram.shares.size(), 4u);
    // Each share is a sum of 4 x 96 weights of equal volume, each rounded once.
    for (const double share : histogram.shares) EXPECT_NEAR(share, .25, 384 * 2.3e-16);
}

}  // namespace
}  // namespace lamina
