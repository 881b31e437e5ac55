// SPDX-License-Identifier: Apache-2.0
// Conforming meshes of a constant field: every pixel is 1 - exp(-extinction * chord), whatever the
// tets are. So there are no cracks, no fragments drawn twice, and no effects of the rasteriser's
// grid.
#include "projection_fixture.h"
#include "support/split_box.h"

namespace lamina {
namespace {

MeshData scaled(MeshData data, double factor) {
    for (glm::dvec3& point : data.points) point = factor * point;
    return data;
}

class Conforming : public ProjectionTest {
  protected:
    // Compares pictures with the tracer's, in views along the axes and diagonals of the box [0,
    // 1]^3, in which walls of the mesh are edge-on and meet pixel centres, and in oblique ones.
    void expect_constant(const SceneMesh& mesh, double bound, const std::string& name) {
        const std::vector<glm::dvec3> eyes{{.5, .5, 3},     {3, .5, .5},  {.5, -2, .5},
                                           {2, 2, 2},       {.5, 2, 2},   {1.9, -.7, .8},
                                           {-1.2, 1.5, .3}, {.4, .45, .6}};
        for (const glm::dvec3& eye : eyes) {
            for (const int pixels : {48, 65}) {
                for (const auto projection : {Projection::perspective, Projection::orthographic}) {
                    Scene scene = projection_scene(
                        TransferFunction::linear({knot(0, {1, 1, 1}, 2.5)}), pixels, pixels);
                    scene.camera->projection = projection;
                    scene.camera->eye = eye;
                    scene.camera->center = {.5, .5, .5};
                    scene.camera->up = {0, 1, .001};
                    scene.camera->fov_y = 50;
                    scene.camera->height = 1.5;
                    const double error =
                        image_error(project(mesh, scene, capabilities()), trace(mesh, scene))
                            .all.linf;
                    EXPECT_LE(error, bound)
                        << name << ", eye " << eye.x << " " << eye.y << " " << eye.z << ", "
                        << pixels << " pixels, projection " << static_cast<int>(projection);
                }
            }
        }
    }
};

const auto zero = [](const glm::dvec3&) { return 0.0; };

// The bound is in 1/255. Float32 OVER of 100 tets errs by 100 * 6e-8 * 255 = .0015. A face that is
// off by 9e-6 of an edge (docs/numerics.md, section 6) is so for both of its tets, and this cancels
// except at the box's surface: 2.5 * .2 * 9e-6 * 255 = .001. A crack between Kuhn's tets, or a tet
// drawn twice, costs units.
TEST_P(Conforming, KuhnMeshesHaveNoCracks) {
    expect_constant(scene_mesh(scaled(test::kuhn_box({8, 8, 8}, zero), 0.125)), 0.02, "kuhn");
}

// So many tets have depths on faces in float32, except for faces that are edge-on.
TEST_P(Conforming, LargeKuhnMeshesHaveNoCracks) {
    expect_constant(scene_mesh(scaled(test::kuhn_box({13, 13, 13}, zero), 1 / 13.0)), 0.02,
                    "kuhn 13");
}

// A box of `across` x `across` pixels whose sides lie exactly on pixel centres, seen along an axis:
// rays along a side must meet the box if they do in the tracer. A single wrong one costs 200.
TEST_P(Conforming, SidesOnPixelCentersMeetTheTracersRays) {
    const SceneMesh mesh = scene_mesh(scaled(test::kuhn_box({2, 2, 2}, zero), 0.5));
    for (const int across : {50, 100, 256}) {
        for (int axis = 0; axis < 3; ++axis) {
            for (const int turn : {1, 2}) {
                const int pixels = across + 3;  // odd: the middle is a pixel's centre
                Scene scene = projection_scene(TransferFunction::linear({knot(0, {1, 1, 1}, 2.5)}),
                                               pixels, pixels);
                scene.camera->projection = Projection::orthographic;
                scene.camera->center = scene.camera->eye = {.5, .5, .5};
                scene.camera->eye[axis] += 3;
                scene.camera->up = {};
                scene.camera->up[(axis + turn) % 3] = 1;
                scene.camera->height = static_cast<double>(pixels) / across;
                const double error =
                    image_error(project(mesh, scene, capabilities()), trace(mesh, scene)).all.linf;
                EXPECT_LE(error, 0.02) << across << " pixels, axis " << axis << ", turn " << turn;
            }
        }
    }
}

TEST_P(Conforming, IrregularMeshesHaveNoCracks) {
    expect_constant(scene_mesh(test::split_box(3, 2000, 1e-2, zero)), 0.02, "split");
}

TEST_P(Conforming, GradedMeshesHaveNoCracks) {
    expect_constant(scene_mesh(test::split_box(4, 4000, 1e-4, zero)), 0.2, "graded");
}

INSTANTIATE_TEST_SUITE_P(Engines, Conforming, every_engine, engine_name);

}  // namespace
}  // namespace lamina
