// SPDX-License-Identifier: Apache-2.0
// With colours above 1, the error that exact segments claim grows in proportion.
#include "cpu_fixture.h"
#include "exact_fixture.h"

namespace lamina {
namespace {

// A volume that tools/fuzz_scenes --first 9504 found: int16 samples of only a few different values,
// between which the transfer function has many points with colours up to `brightest`.
Volume sparse() {
    Grid grid = test::grid_of({11, 2, 1}, Centering::cell);
    grid.step = {glm::dvec3(-.027324965517241378, .17761227586206899, 1.1749735172413793),
                 glm::dvec3(1.018189620689655, .3189509655172414, -.02453468965517241),
                 glm::dvec3(-.22730084597701153, .7168718988505747, -.11365042298850576)};
    grid.origin = {5.0464962373073075, -8.691908591223982, 3.381509738112809};
    return test::volume_of<std::int16_t>(grid, [](double x, double y, double) {
        const int place = static_cast<int>(2 * x + y);
        return place == 2    ? -1453
               : place == 9  ? -1820
               : place == 11 ? -2413
               : place == 13 ? -2123
                             : -4239;
    });
}

TransferFunction many_colors(double brightest) {
    reference_test::Random random(9504);
    std::vector<TransferKnot> knots;
    for (double value = -4375; value < -1329; value += random.uniform(1, 22)) {
        const double extinction = random.uniform(0, 1) < .65 ? 0 : random.uniform(0, 122);
        knots.push_back(knot(value,
                             {random.uniform(0, brightest), random.uniform(0, brightest),
                              random.uniform(0, brightest)},
                             extinction));
    }
    return TransferFunction::linear(knots);
}

Scene sparse_scene(double brightest) {
    Scene scene = exact_scene(many_colors(brightest), Projection::orthographic);
    scene.camera->eye = {4.34537995494, -7.28572573915, 15.7784443469};
    scene.camera->center = {4.84054699635, -8.89009754771, 4.44589845152};
    scene.camera->up = {0, 1, 0};
    scene.camera->height = 2.399423;
    scene.width = 228;
    scene.height = 222;
    return scene;
}

double claimed_error(const Volume& volume, const Scene& scene) {
    const Facts facts = measure(scene, volume, measure_bricks(volume));
    return make_plan(scene, facts, cpu_capabilities(), {}).slice.found_error();
}

TEST(BrightColors, ExactSegmentsKeepTheErrorTheyClaim) {
    const Volume volume = sparse();
    const Scene scene = sparse_scene(1000);
    const double error = linf(render_tiles(volume, scene), trace(volume, scene, 1e-8));
    // The error that is claimed for colours up to 1 is exceeded here.
    EXPECT_GT(error, exact_segment_error);
    EXPECT_LE(error, claimed_error(volume, scene));
    EXPECT_GT(claimed_error(volume, scene), scene.max_error);
}

TEST(BrightColors, EnlargeTheClaimedErrorInProportion) {
    const Volume volume = sparse();
    EXPECT_DOUBLE_EQ(claimed_error(volume, sparse_scene(.5)), exact_segment_error);
    const double once = claimed_error(volume, sparse_scene(10));
    EXPECT_GT(once, exact_segment_error);
    EXPECT_NEAR(claimed_error(volume, sparse_scene(20)), 2 * once, 1e-9);
}

}  // namespace
}  // namespace lamina
