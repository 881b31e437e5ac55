// SPDX-License-Identifier: Apache-2.0
// Meshes with values far from all others, like those that mark missing data, against the tracer.
#include "facts/drawn_range.h"
#include "projection_fixture.h"
#include "support/split_box.h"

namespace lamina {
namespace {

constexpr double promised = .05;  // of a float32 picture, in 1/255 (docs/precision.md)

// Returns a transfer function with points all over the field's values, of random colours. `beyond`:
// the extinction outside them.
TransferFunction colorful(int points, double beyond) {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> share(0, 1);
    std::vector<TransferKnot> knots;
    for (int i = 0; i <= points; ++i) {
        const double extinction = i == 0 || i == points ? beyond : 3 * share(random);
        knots.push_back(
            knot(1. * i / points, {share(random), share(random), share(random)}, extinction));
    }
    return TransferFunction::linear(knots);
}

SceneMesh marked_mesh(double marker, std::size_t every) {
    MeshData data = test::split_box(5, 900, .02, waves);
    auto& values = data.point_scalars.front().values;
    for (std::size_t i = every / 2; i < values.size(); i += every) values[i] = marker;
    return scene_mesh(std::move(data));
}

Scene marked_scene(const TransferFunction& transfer_function) {
    Scene scene = projection_scene(transfer_function, 80, 60);
    scene.camera->eye = {1.6, -.5, .9};
    scene.camera->center = {.5, .5, .5};
    scene.camera->up = {0, 1, .001};
    scene.camera->fov_y = 60;
    return scene;
}

class Markers : public ProjectionTest {
  protected:
    double error(const SceneMesh& mesh, const Scene& scene) const {
        return image_error(project(mesh, scene, capabilities()), trace(mesh, scene)).all.linf;
    }
};

TEST_P(Markers, CostNoDigitsWhateverTheirSizeAndSign) {
    for (const double marker : {-9999., 1e6, -1e20, 9.97e36}) {
        for (const int points : {4, 40}) {
            for (const double beyond : {0., 1.}) {
                const SceneMesh mesh = marked_mesh(marker, 300);
                EXPECT_LE(error(mesh, marked_scene(colorful(points, beyond))), promised)
                    << marker << ", " << points << " points, " << beyond;
            }
        }
    }
}

TEST_P(Markers, CostNoDigitsWithAnyColoring) {
    const SceneMesh mesh = marked_mesh(-32768, 20);
    Scene scene = marked_scene(colorful(40, 1));
    scene.project.coloring = Coloring::analytic;
    EXPECT_LE(error(mesh, scene), promised);
    scene.camera->projection = Projection::orthographic;
    scene.camera->height = 1.6;
    EXPECT_LE(error(mesh, scene), promised);
}

// Gradients around a marker are longer than others by as much as the marker is larger than other
// values.
TEST_P(Markers, LeaveLightAsItIs) {
    for (const double marker : {-9999., 9.97e36}) {
        const SceneMesh mesh = marked_mesh(marker, 100);
        Scene scene = marked_scene(colorful(20, 0));
        scene.lighting = Lighting{};
        (*scene.lighting)->smallest_gradient = .05;
        EXPECT_LE(error(mesh, scene), scene.max_error) << marker;
    }
}

// A table adds the error that the plan states; markers add no more than with other colourings.
TEST_P(Markers, CostNoDigitsOfTables) {
    const SceneMesh mesh = marked_mesh(9.97e36, 100);
    Scene scene = marked_scene(colorful(12, 1));
    scene.project.table =
        TableSettings{.scalar = 512, .length = 32, .format = TableFormat::float32};
    const ProjectPlan plan = plan_of(mesh, scene, capabilities()).project;
    EXPECT_TRUE(plan.windowed);
    // The factor is for what the plan may miss: it tries the table only on some rays and tets.
    EXPECT_LE(error(mesh, scene), 1.5 * plan.trial_error.segments + promised);
}

// If only a step shows, the window around the visible scalars would have no width.
TEST_P(Markers, LeaveStepsWhereTheyAre) {
    for (const double marker : {-9999., 9.97e36}) {
        const SceneMesh mesh = marked_mesh(marker, 100);
        const auto step =
            TransferFunction::linear({knot(.5, {1, .5, 0}, 0), knot(.5, {1, .5, 0}, 2)});
        EXPECT_LE(error(mesh, marked_scene(step)), promised) << marker;
    }
}

// Without values far away, scalars are normalised to the range of the mesh.
TEST_P(Markers, ChangeNothingWhereThereAreNone) {
    const SceneMesh mesh = scene_mesh(test::split_box(5, 900, .02, waves));
    for (const int points : {4, 40}) {
        const Scene scene = marked_scene(colorful(points, 0));
        EXPECT_FALSE(plan_of(mesh, scene, capabilities()).project.windowed);
    }
}

INSTANTIATE_TEST_SUITE_P(Engines, Markers, every_engine, engine_name);

TEST(FarScalars, ReachBeyondTheWindowOnlyIfTheyMeetIt) {
    const ValueRange window{10, 12};
    EXPECT_FALSE(runs_beyond({10, 12}, window, 8));
    EXPECT_FALSE(runs_beyond({-6, 11}, window, 8));  // 8 widths below
    EXPECT_TRUE(runs_beyond({-6.1, 11}, window, 8));
    EXPECT_TRUE(runs_beyond({11, 1e36}, window, 8));
    EXPECT_FALSE(runs_beyond({12, 1e36}, window, 8));
    EXPECT_FALSE(runs_beyond({-1e36, 10}, window, 8));
}

TEST(FarScalars, AreScaledToWhatFloatsHold) {
    EXPECT_EQ(far_scale(-5, 1e9), 1);
    EXPECT_EQ(far_scale(-5, 1e40) * 1e40, farthest_normalised);
    EXPECT_EQ(far_scale(-0x1p60, 1), 1);
    EXPECT_EQ(far_scale(-0x1p90, 1), 0x1p-30);
}

}  // namespace
}  // namespace lamina
