// SPDX-License-Identifier: Apache-2.0
// One tet in all poses against the reference tracer: tests the arithmetic of projection by itself.
#include <glm/geometric.hpp>

#include "projection_fixture.h"

namespace lamina {
namespace {

// Largest error, in 1/255. Float32 errs by some 1e-6 in the length and in the exponential, 3e-4 /
// 255 each; all else is for the error of the table of front weights.
constexpr double bound = 0.05;

MeshData tet(const std::array<glm::dvec3, 4>& points, const std::array<double, 4>& scalars) {
    MeshData data;
    data.points.assign(points.begin(), points.end());
    data.tets = {{0, 1, 2, 3}};
    data.point_scalars = {{"s", {scalars.begin(), scalars.end()}}};
    return data;
}

TransferFunction constant(double extinction) {
    return TransferFunction::linear({knot(0, {1, .7, .3}, extinction)});
}

// Returns one linear piece of extinction, of one colour: opacity has a closed form.
TransferFunction ramp(double extinction) {
    return TransferFunction::linear({knot(0, {1, .7, .3}, 0), knot(1, {1, .7, .3}, extinction)});
}

// Returns changing colours, a narrow peak, a gap and a step inside the scalars of most tets, so
// that these are drawn in parts.
TransferFunction crooked(double extinction) {
    return TransferFunction::linear(
        {knot(0, {0, .2, 1}, .2 * extinction), knot(.3, {0, 1, .3}, .5 * extinction),
         knot(.4, {1, 1, 0}, 0), knot(.45, {1, 1, 0}, 0), knot(.5, {1, .2, 1}, extinction),
         knot(.55, {1, 0, 0}, .1 * extinction), knot(.7, {.3, 0, 1}, .1 * extinction),
         knot(.7, {1, .6, 0}, .8 * extinction)});
}

Scene scene_of(const glm::dvec3& eye, const glm::dvec3& center, const glm::dvec3& up,
               const TransferFunction& transfer_function, int pixels) {
    Scene scene = projection_scene(transfer_function, pixels, pixels);
    scene.camera->eye = eye;
    scene.camera->center = center;
    scene.camera->up = up;
    return scene;
}

class SingleTet : public ProjectionTest {
  protected:
    void expect_exact(const SceneMesh& mesh, const Scene& scene, const std::string& name) {
        const Image drawn = project(mesh, scene, capabilities());
        for (const float value : drawn.rgba) ASSERT_TRUE(std::isfinite(value)) << name;
        EXPECT_LE(image_error(drawn, trace(mesh, scene)).all.linf, bound) << name;
    }
};

TEST_P(SingleTet, RandomPosesMatchTheTracer) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (int pose = 0; pose < 150; ++pose) {
        std::array<glm::dvec3, 4> points;
        std::array<double, 4> scalars;
        for (std::size_t i = 0; i < 4; ++i) {
            points[i] = 0.5 * direction(random);  // edges up to 1
            scalars[i] = uniform(random);
        }
        const SceneMesh mesh = scene_mesh(tet(points, scalars));
        // The eye is .6 to 1e4 edge lengths away, and the picture just holds the tet.
        const double distance = 0.6 * std::pow(1e4 / 0.6, uniform(random));
        const double extinction = 5 * uniform(random);
        Scene scene = scene_of(distance * direction(random), glm::dvec3(0), direction(random),
                               pose % 2 == 0   ? crooked(extinction)
                               : pose % 4 == 1 ? ramp(extinction)
                                               : constant(extinction),
                               256);
        if (pose % 3 == 0) {
            scene.camera->projection = Projection::orthographic;
            scene.camera->height = 1;
        } else {
            scene.camera->fov_y =
                std::min(120.0, 2 * std::atan(0.5 / distance) * 180 / 3.14159265358979);
        }
        if (pose % 5 == 0) scene.project.coloring = Coloring::analytic;
        expect_exact(mesh, scene, "pose " + std::to_string(pose));
    }
}

// The poses of docs/numerics.md, section 7, with points, edges and faces exactly on pixel centres
// (65 pixels) and between them.
TEST_P(SingleTet, DegeneratePosesMatchTheTracer) {
    const std::array<double, 4> scalars{0, 1, .5, .25};
    const SceneMesh corner =
        scene_mesh(tet({glm::dvec3(0), {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, scalars));
    const SceneMesh needle =
        scene_mesh(tet({glm::dvec3(0), {1, 0, 0}, {0, 1e-5, 0}, {0, 0, 1e-5}}, scalars));
    const SceneMesh sliver =
        scene_mesh(tet({glm::dvec3(0), {1, 0, 0}, {1, 1, .02}, {0, 1, 0}}, scalars));
    const SceneMesh flat =
        scene_mesh(tet({glm::dvec3(0), {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, scalars));
    struct Pose {
        glm::dvec3 eye, center, up;
    };
    const std::vector<Pose> poses{
        {{.25, .25, 3}, {.25, .25, 0}, {0, 1, 0}},   // a corner inside the face opposite
        {{.25, .25, -3}, {.25, .25, 0}, {0, 1, 0}},  // the same from behind
        {{2, 2, .1}, {0, 0, .1}, {0, 0, 1}},         // edges cross
        {{.3, -2, 0}, {.3, 0, 0}, {0, 0, 1}},        // a face edge-on
        {{3, 0, 0}, {0, 0, 0}, {0, 0, 1}},           // an edge end-on
        {{0, 0, -2}, {0, 0, 0}, {0, 1, 0}},          // an edge end-on, two faces edge-on
        {{.2, .2, .2}, {1, .3, .2}, {0, 0, 1}},      // the eye inside
        {{0, 0, 0}, {1, 1, 1}, {0, 0, 1}},           // on a corner
        {{.5, 0, 0}, {.4, 1, 1}, {0, 0, 1}},         // on an edge
        {{.2, .2, 0}, {.3, .3, 1}, {0, 1, 0}},       // in a face
        {{.2, .2, .5}, {.2, .2, 2}, {0, 1, 0}},      // part of it behind the eye
        {{.2, .2, 3}, {.2, .2, 4}, {0, 1, 0}},       // all of it
    };
    int number = 0;
    for (const Pose& pose : poses) {
        for (const SceneMesh* mesh : {&corner, &needle, &sliver, &flat}) {
            for (const int pixels : {64, 65}) {
                Scene scene = scene_of(pose.eye, pose.center, pose.up, ramp(3), pixels);
                scene.camera->fov_y = 70;
                if (pixels == 65) scene.transfer_function = crooked(4);
                const std::string name = std::to_string(number) + ", " + std::to_string(pixels);
                expect_exact(*mesh, scene, "perspective " + name);
                scene.camera->projection = Projection::orthographic;
                scene.camera->height = 2;
                expect_exact(*mesh, scene, "orthographic " + name);
            }
            ++number;
        }
    }
}

// Both geometries are exact, but the triangles' corners are rounded to the rasteriser's grid, by up
// to 1/512 pixel in each direction. This shifts the picture of the tet by as much, and so changes a
// pixel by up to 1.5 / 512 of the change from pixel to pixel, which is below 255 / 20.
TEST_P(SingleTet, TrianglesAndSilhouettesAgree) {
    std::mt19937 random(7);
    for (int pose = 0; pose < 20; ++pose) {
        std::array<glm::dvec3, 4> points;
        for (glm::dvec3& point : points) point = 0.5 * direction(random);
        const SceneMesh mesh = scene_mesh(tet(points, {0, 1, .3, .6}));
        Scene scene =
            scene_of(1.5 * direction(random), glm::dvec3(0), direction(random), ramp(2), 96);
        if (pose % 2 == 0) {
            scene.camera->projection = Projection::orthographic;
            scene.camera->height = 1.1;
        }
        scene.project.geometry = ProjectGeometry::triangles;
        const ErrorNorms error =
            image_error(project(mesh, scene, capabilities()), trace(mesh, scene)).all;
        EXPECT_LE(error.l2, 0.04) << pose;
    }
}

INSTANTIATE_TEST_SUITE_P(Engines, SingleTet, every_engine, engine_name);

}  // namespace
}  // namespace lamina
