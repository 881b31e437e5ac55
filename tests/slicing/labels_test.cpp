// SPDX-License-Identifier: Apache-2.0
// Volumes of labels: large regions of one value, at which the transfer function has a step.
#include <gtest/gtest.h>

#include <cmath>

#include "slicing/slicing_fixture.h"
#include "support/volume_of.h"

namespace lamina {
namespace {

// At the value of a step the later side counts, also at the largest value. The labels are layers
// across x, and a ray crosses at most 2 * labels borders. Each puts the sample of one slab on the
// wrong side, which costs at most the extinction times the slab's length in optical depth, and no
// more in opacity.
TEST_P(BothEngines, StepsAtLabelsShowTheirLaterSide) {
    constexpr int labels = 7, slabs = 2048;
    constexpr double extinction = .3;
    const Volume volume = test::volume_of<std::uint8_t>(
        test::grid_of({2 * labels, 8, 8}, Centering::node),
        [](double i, double, double) { return 3 * std::floor(i / 2); });
    std::vector<TransferKnot> points{knot(0, {1, 0, 0}, .02)};
    for (int label = 1; label < labels; ++label) {
        const double value = 3 * label;
        points.push_back(knot(value, points.back().optics.color, points.back().optics.extinction));
        points.push_back(knot(value, {label % 2, .5, 1. / label}, label % 2 ? extinction : .05));
    }
    for (const Projection projection : {Projection::orthographic, Projection::perspective}) {
        Scene scene = unit_box_scene(TransferFunction::linear(points), projection);
        scene.camera->eye = {20, 15, 18};
        scene.camera->center = {6.5, 3.5, 3.5};
        scene.camera->height = 12;
        scene.slice.samples = slabs;
        const double longest =
            2 * std::hypot(13, 7, 7);  // bound on the box's depth times a ray's slant
        const double bound = 255 * 2 * labels * extinction * longest / slabs;
        for (const auto classification : {Classification::post, Classification::preintegrated}) {
            scene.slice.classification = classification;
            EXPECT_LT(linf(draw(volume, scene), trace(volume, scene, 1e-6)), bound);
        }
    }
}

}  // namespace
}  // namespace lamina
