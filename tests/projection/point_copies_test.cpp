// SPDX-License-Identifier: Apache-2.0
// Meshes whose cells share no points: values are by corner, all else is by place.
#include "support/point_copies.h"
#include "plan/plan.h"
#include "projection_fixture.h"
#include "reference/lit_fixtures.h"
#include "scene/clip.h"
#include "support/clips.h"
#include "support/split_box.h"

namespace lamina {
namespace {

constexpr std::size_t tets_of_cube = 6;

class PointCopies : public ProjectionTest {
  protected:
    static Scene scene(double extinction = 4) {
        Scene scene = projection_scene(
            TransferFunction::linear({knot(.1, {.9, .2, .1}, 0), knot(.4, {.3, .9, .2}, extinction),
                                      knot(1, {.1, .3, 1}, .3 * extinction)}),
            60, 45);
        scene.camera->eye = {1.6, -.5, .9};
        scene.camera->center = {.5, .5, .5};
        scene.camera->up = {0, 1, .001};
        scene.camera->fov_y = 60;
        scene.camera->height = 1.6;
        return scene;
    }
    static Lighting light() {
        Lighting lighting = reference_test::directional();
        lighting.smallest_gradient = .05;
        return lighting;
    }
    // Returns 5 x 4 x 3 cubes in the unit box.
    static MeshData cubes() {
        MeshData data = test::kuhn_box(
            {5, 4, 3}, [](const glm::dvec3& p) { return ripples(p / glm::dvec3(5, 4, 3)); });
        for (glm::dvec3& point : data.points) point /= glm::dvec3(5, 4, 3);
        return data;
    }
    void expect_same_pictures(const Scene& scene, const std::string& what) const {
        const SceneMesh shared =
            scene_mesh(test::with_copies(cubes(), test::one_cell, test::no_jump));
        const Image expected = project(shared, scene, capabilities());
        for (const std::size_t cell_tets : {std::size_t{1}, tets_of_cube}) {
            const SceneMesh split =
                scene_mesh(test::with_copies(cubes(), cell_tets, test::no_jump));
            EXPECT_EQ(linf(project(split, scene, capabilities()), expected), 0)
                << what << ", cells of " << cell_tets << " tets";
            EXPECT_EQ(linf(trace(split, scene), trace(shared, scene)), 0) << what;
        }
    }
    static double linf(const Image& a, const Image& b) { return image_error(a, b).all.linf; }
};

TEST_P(PointCopies, WithEqualValuesDoNotChangeThePicture) {
    for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
        for (const Coloring coloring :
             {Coloring::preintegrated, Coloring::analytic, Coloring::attenuation}) {
            for (const bool lit : {false, true}) {
                if (lit && mixes_colors(coloring)) continue;
                Scene drawn = scene();
                drawn.camera->projection = projection;
                drawn.project.coloring = coloring;
                if (lit) drawn.lighting = light();
                const std::string what =
                    std::string(name_of(projection)) + ", " + name_of(coloring);
                expect_same_pictures(drawn, what + (lit ? ", lit" : ""));
                drawn.camera->eye = {.43, .52, .37};  // inside
                expect_same_pictures(drawn, what + (lit ? ", lit, inside" : ", inside"));
            }
        }
    }
}

TEST_P(PointCopies, AreCutAlikeByAClip) {
    Scene clipped = scene();
    clipped.lighting = light();
    clipped.clip.planes.push_back({{.5, .4, .45}, {.3, 1, .2}});
    clipped.clip.planes.push_back({{.7, .5, .5}, {-1, .1, .4}});
    const auto cut = [&](std::size_t cell_tets, const auto& jump) {
        const auto mesh = std::make_shared<const SceneMesh>(
            scene_mesh(test::with_copies(cubes(), cell_tets, jump)));
        return clipped_mesh(mesh, clipped.clip, true, "cut");
    };
    const auto shared = cut(test::one_cell, test::no_jump);
    for (const std::size_t cell_tets : {std::size_t{1}, tets_of_cube}) {
        const auto split = cut(cell_tets, test::no_jump);
        EXPECT_EQ(split->mesh.tets().size(), shared->mesh.tets().size());
        EXPECT_EQ(split->mesh.findings().boundary_faces, shared->mesh.findings().boundary_faces);
        EXPECT_LE(linf(project(*split, clipped, capabilities()),
                       project(*shared, clipped, capabilities())),
                  1e-3);
    }
    // The tracer cuts rays in place of tets.
    Scene drawn = clipped;
    drawn.clip = {};
    const SceneMesh whole =
        scene_mesh(test::with_copies(cubes(), tets_of_cube, test::RandomJump{.3}));
    EXPECT_LE(linf(project(*cut(tets_of_cube, test::RandomJump{.3}), drawn, capabilities()),
                   trace(whole, clipped)),
              clipped.max_error);
}

// A value of one cell beside a face must not be taken for the other cell's: jumps of .3 change
// pixels by tens of codes.
TEST_P(PointCopies, WithJumpsKeepMaxErrorAgainstTheTracer) {
    for (const std::size_t cell_tets : {std::size_t{1}, tets_of_cube}) {
        const SceneMesh mesh =
            scene_mesh(test::with_copies(cubes(), cell_tets, test::RandomJump{.3}));
        for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
            for (const bool lit : {false, true}) {
                for (const ProjectGeometry geometry :
                     {ProjectGeometry::silhouette, ProjectGeometry::triangles}) {
                    if (lit && geometry == ProjectGeometry::triangles) continue;
                    Scene drawn = scene();
                    drawn.camera->projection = projection;
                    drawn.project.geometry = geometry;
                    if (lit) drawn.lighting = light();
                    EXPECT_LE(linf(project(mesh, drawn, capabilities()), trace(mesh, drawn)),
                              drawn.max_error)
                        << name_of(projection) << (lit ? ", lit, " : ", ") << name_of(geometry)
                        << ", cells of " << cell_tets << " tets";
                }
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(, PointCopies, every_engine, engine_name);

}  // namespace
}  // namespace lamina
