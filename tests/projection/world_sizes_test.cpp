// SPDX-License-Identifier: Apache-2.0
// Meshes as small as atoms and as large as galaxies give the picture of one of size 1.
#include "base/error.h"
#include "projection_fixture.h"
#include "support/split_box.h"

namespace lamina {
namespace {

// Returns the mesh `size` times as large; resized() gives it the same opacity.
SceneMesh resized_mesh(double size) {
    MeshData data =
        test::split_box(4, 60, .05, [](const glm::dvec3& p) { return p.x * p.y + .5 * p.z; });
    for (glm::dvec3& point : data.points) point *= size;
    return scene_mesh(std::move(data));
}

Scene resized(Scene scene, double size) {
    scene.transfer_function = scene.transfer_function->attenuated(1 / size);
    scene.camera->eye *= size;
    scene.camera->center *= size;
    scene.camera->height *= size;
    return scene;
}

std::vector<Scene> scenes() {
    std::vector<Scene> all;
    const TransferFunction optics = TransferFunction::linear(
        {knot(0, {0, .2, 1}, 0), knot(.5, {0, 1, .3}, 3), knot(1.5, {1, .3, 0}, 1)});
    for (const auto geometry : {ProjectGeometry::silhouette, ProjectGeometry::triangles}) {
        Scene scene = projection_scene(optics, 40, 30);
        scene.project.geometry = geometry;
        scene.camera->eye = {1.9, -.7, 1.6};
        scene.camera->center = {.5, .5, .5};
        scene.camera->height = 1.7;
        all.push_back(scene);
        scene.camera->projection = Projection::orthographic;
        all.push_back(scene);
        scene.camera->projection = Projection::perspective;
        scene.camera->eye = {.4, .3, .6};
        scene.camera->fov_y = 80;
        all.push_back(scene);
        scene.camera->eye = {1.9, -.7, 1.6};
        scene.project.coloring = Coloring::attenuation;
        scene.project.interpolation = Interpolation::linear;
        if (geometry == ProjectGeometry::triangles) all.push_back(scene);
    }
    return all;
}

using ProjectedWorldSizes = ProjectionTest;
INSTANTIATE_TEST_SUITE_P(Projection, ProjectedWorldSizes, every_engine, engine_name);

TEST_P(ProjectedWorldSizes, PowersOfTwoChangeNoBit) {
    const SceneMesh mesh = resized_mesh(1);
    for (const Scene& scene : scenes()) {
        const Image picture = project(mesh, scene, capabilities());
        for (const int exponent : {-190, -104, 71, 190}) {
            const double size = std::ldexp(1., exponent);
            const SceneMesh other = resized_mesh(size);
            EXPECT_EQ(project(other, resized(scene, size), capabilities()).rgba, picture.rgba)
                << exponent;
        }
    }
}

TEST_P(ProjectedWorldSizes, GalaxiesAndAtomsMatchTheTracer) {
    for (const double size : {1e-58, 1e-31, 1e21, 1e58}) {
        const SceneMesh mesh = resized_mesh(size);
        const Scene scene = resized(scenes().front(), size);
        // A ray meets some 30 tets, each good to 1e-6 of its opacity and colour.
        EXPECT_LE(image_error(project(mesh, scene, capabilities()), trace(mesh, scene)).all.linf,
                  255 * 3e-5)
            << size;
    }
}

TEST_P(ProjectedWorldSizes, SizesBeyondExactPredicatesAreRefused) {
    const SceneMesh mesh = resized_mesh(1e70);
    const Scene scene = resized(scenes().front(), 1e70);
    EXPECT_THROW(project(mesh, scene, capabilities()), Error);
}

}  // namespace
}  // namespace lamina
