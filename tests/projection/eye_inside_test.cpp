// SPDX-License-Identifier: Apache-2.0
// Small meshes seen from inside and from close by, when tets reach behind the eye and far beyond
// the picture.
#include <algorithm>

#include "projection_fixture.h"
#include "support/split_box.h"

namespace lamina {
namespace {

constexpr double most_extinction = 1.5;

// Returns a mesh of cubes of six tets, whose corners are moved by up to a tenth of an edge.
SceneMesh random_mesh(const std::array<std::int32_t, 3>& cubes, std::mt19937& random) {
    std::uniform_real_distribution<double> value(0, 1), move(-.1, .1);
    MeshData data = test::kuhn_box(cubes, [&](const glm::dvec3&) { return value(random); });
    for (glm::dvec3& point : data.points)
        point += glm::dvec3(move(random), move(random), move(random));
    return scene_mesh(std::move(data));
}

SceneMesh random_mesh(std::mt19937& random) {
    const auto cubes = [&] { return static_cast<std::int32_t>(1 + random() % 2); };
    const std::int32_t x = 1 + cubes(), y = cubes(), z = cubes();
    return random_mesh({x, y, z}, random);
}

// Returns a point anywhere in a tet, or almost at one of its corners or faces.
glm::dvec3 eye_in(const SceneMesh& mesh, std::mt19937& random) {
    std::exponential_distribution<double> share;
    const auto tets = mesh.mesh.tets();
    const Tet& tet = tets[random() % tets.size()];
    const auto kind = random() % 3;
    glm::dvec3 sum(0);
    double all = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        const bool far = (kind == 1 && i == 0) || (kind == 2 && i > 0);
        const double weight =
            (far ? std::pow(10., -1. - static_cast<double>(random() % 5)) : 1) * share(random);
        sum += weight * mesh.mesh.points()[static_cast<std::size_t>(tet[i])];
        all += weight;
    }
    return sum / all;
}

Scene random_scene(const SceneMesh& mesh, std::mt19937& random) {
    Scene scene = projection_scene(
        TransferFunction::linear({knot(0, {1, .2, 0}, 0), knot(.4, {1, 1, 0}, .3),
                                  knot(.6, {0, .3, 1}, most_extinction), knot(1, {.1, 1, 0}, .2)}),
        48, 36);
    scene.project.coloring = Coloring::analytic;  // no table
    scene.camera->eye = eye_in(mesh, random);
    scene.camera->center = scene.camera->eye + direction(random);
    scene.camera->up = direction(random);
    scene.camera->fov_y = random() % 2 > 0 ? 50 : 100;
    scene.camera->height = 2;
    if (random() % 8 == 0) scene.camera->projection = Projection::orthographic;
    return scene;
}

struct Errors {
    double worst, most;  // largest, and 90th percentile, of all channels, in 1/255
};

Errors errors(const Image& picture, const Image& reference) {
    std::vector<double> found;
    for (std::size_t i = 0; i < picture.rgba.size(); ++i)
        found.push_back(255 * std::abs(double{picture.rgba[i]} - double{reference.rgba[i]}));
    std::ranges::sort(found);
    return {found.back(), found[found.size() * 9 / 10]};
}

class EyeInside : public ProjectionTest {
  protected:
    // Nine tenths of the pixels have only two kinds of errors: roundings of float32, at most 50 in
    // an optical depth of at most 5, and errors of the weights of colours, 2e-6 in at most 40
    // pieces.
    //
    // The others are due to grids. Rasterisers put corners on a grid of 1/256 pixel, the cpu engine
    // on one of 1/4096 (and float32 places are about as coarse). A pixel centre that is this near
    // to a tet's outline may get the tet or miss it. Its segment is short: for faces at least a
    // pixel wide at most the same share of the longest edge, 1.9. Silhouettes depend on no grid.
    void expect_the_tracers(const SceneMesh& mesh, Scene scene, int number) {
        const Image reference = trace(mesh, scene);
        const double exact = 255 * (5 * 50 * 6e-8 + 40 * 2e-6);
        const double grid = GetParam() == Engine::tiles ? 1. / 2048 : 1. / 256;
        for (const auto geometry : {ProjectGeometry::triangles, ProjectGeometry::silhouette}) {
            scene.project.geometry = geometry;
            const Errors found = errors(project(mesh, scene, capabilities()), reference);
            const bool snapped = geometry == ProjectGeometry::triangles;
            EXPECT_LE(found.most, exact) << number;
            EXPECT_LE(found.worst, snapped ? 255 * most_extinction * 1.9 * grid : exact)
                << number << (snapped ? " triangles" : " silhouette");
        }
    }
};
INSTANTIATE_TEST_SUITE_P(Projection, EyeInside, every_engine, engine_name);

TEST_P(EyeInside, PicturesMatchTheTracer) {
    std::mt19937 random(9);
    for (int number = 0; number < 40; ++number) {
        const SceneMesh mesh = random_mesh(random);
        expect_the_tracers(mesh, random_scene(mesh, random), number);
    }
}

// The eye is at a corner of tets: three faces of each of these tets are seen edge-on, and only a
// rule for ties decides which of them are fronts. The corner lies inside the mesh, because at one
// on its surface the exact picture jumps along lines.
TEST_P(EyeInside, PicturesFromACornerOfTetsMatchTheTracer) {
    std::mt19937 random(10);
    for (int number = 0; number < 20; ++number) {
        const SceneMesh mesh = random_mesh({2, 2, 2}, random);
        Scene scene = random_scene(mesh, random);
        scene.camera->projection = Projection::perspective;
        scene.camera->eye = mesh.mesh.points()[13];  // of 3 x 3 x 3
        scene.camera->center = scene.camera->eye + direction(random);
        expect_the_tracers(mesh, scene, number);
    }
}

// Tets begin at the near plane, in front of the eye by 1e-6 of the diagonal. That shows in dense
// media whose colours change within a few millionths of the diagonal, as they do in needles.
TEST_P(EyeInside, ErrorsCountWhatTheNearPlaneHides) {
    std::mt19937 random(12);
    std::uniform_real_distribution<double> value(0, 1);
    double beyond = 0;
    for (int number = 0; number < 12; ++number) {
        MeshData data = test::kuhn_box({2, 2, 2}, [&](const glm::dvec3&) { return value(random); });
        for (glm::dvec3& point : data.points) point *= glm::dvec3(1, 1e-3, 1e-3);
        const SceneMesh mesh = scene_mesh(std::move(data));
        Scene scene = random_scene(mesh, random);
        scene.camera->projection = Projection::perspective;
        scene.transfer_function = TransferFunction::linear(
            {knot(0, {1, .2, 0}, 300), knot(.5, {0, 1, 0}, 2000), knot(1, {.1, 0, 1}, 3000)});
        const Plan plan = plan_of(mesh, scene, capabilities());
        ASSERT_EQ(plan.project.error.kind, ErrorKind::sampled) << number;
        const double error = errors(project(mesh, scene, capabilities()), trace(mesh, scene)).worst;
        EXPECT_LE(error, plan.project.error.value) << number;
        const MeshFacts::TrialError& found = plan.project.trial_error;
        beyond = std::max(beyond, error - 1.25 * found.segments - found.places);
    }
    EXPECT_GT(beyond, .05);  // float32's roundings: what else is counted would not be enough
}

// Interpolation between three equal scalars may give another number, which may be on the other side
// of the step.
TEST_P(EyeInside, TetsOfOneScalarAtAStepShowOneOfItsSides) {
    std::mt19937 random(11);
    for (int number = 0; number < 20; ++number) {
        const auto field = [](const glm::dvec3& place) { return place.x < .8 ? 1. : 3.; };
        const SceneMesh mesh = scene_mesh(test::kuhn_box({3, 2, 2}, field));
        Scene scene = random_scene(mesh, random);
        scene.transfer_function = TransferFunction::linear(
            {knot(0, {1, .2, 0}, 0), knot(1, {1, 1, 0}, 0), knot(1, {0, .3, 1}, most_extinction),
             knot(4, {.1, 1, 0}, .2)});
        expect_the_tracers(mesh, scene, number);
    }
}

}  // namespace
}  // namespace lamina
