// SPDX-License-Identifier: Apache-2.0
// Clipped meshes: what is cut off, what is left, and the picture of that against the tracer, which
// clips rays and knows nothing of cut meshes.
#include "support/clips.h"

#include <glm/glm.hpp>

#include "projection_fixture.h"
#include "scene/clip.h"
#include "support/delaunay_mesh.h"
#include "support/mesh_checks.h"
#include "support/split_box.h"

namespace lamina {
namespace {

const auto wave = [](const glm::dvec3& p) { return .5 + .5 * std::sin(4 * p.x + 3 * p.y * p.z); };

double volume_of_mesh(const MeshData& mesh) {
    double sum = 0;
    for (const Tet& tet : mesh.tets) sum += test::volume_of_tet(mesh, tet);
    return sum;
}

MeshData kuhn(int cells) {
    MeshData data = test::kuhn_box({cells, cells, cells}, [&](const glm::dvec3& p) {
        return wave(p / static_cast<double>(cells));
    });
    for (glm::dvec3& point : data.points) point /= cells;
    return data;
}

// Planes through points, edges and faces of Kuhn's mesh of 4^3 cells, and all others.
std::vector<HalfSpace> planes() {
    std::vector<HalfSpace> found{{{.25, 0, 0}, {1, 0, 0}},   {{.5, 0, 0}, {1, 1, 0}},
                                 {{0, 0, 0}, {1, -1, 0}},    {{.25, .5, .25}, {1, 1, -1}},
                                 {{.25, 0, .5}, {1, 2, -1}}, {{.5, .5, .5}, {.3, -.7, .2}}};
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(0, 1);
    for (int i = 0; i < 10; ++i) {
        found.push_back({{place(random), place(random), place(random)}, direction(random)});
    }
    return found;
}

HalfSpace other_side(HalfSpace half) {
    half.normal = -half.normal;
    return half;
}

void expect_sound(const MeshData& data, double least_volume) {
    for (const Tet& tet : data.tets) ASSERT_GT(test::volume_of_tet(data, tet), least_volume);
    const TetMesh mesh(data, "cut");
    EXPECT_TRUE(mesh.findings().conforming());
    EXPECT_EQ(mesh.findings().degenerate, 0);
    EXPECT_EQ(mesh.findings().inverted, 0);
    EXPECT_EQ(mesh.findings().duplicates, 0);
    EXPECT_EQ(mesh.findings().folded_faces, 0);
    EXPECT_EQ(mesh.findings().unused_points, 0);
}

constexpr double off_plane = 1e-10 * 1.74;  // of the unit box

TEST(CutMesh, BothSidesTogetherAreTheWhole) {
    for (const MeshData& whole : {kuhn(4), test::split_box(7, 600, .05, wave)}) {
        for (const HalfSpace& half : planes()) {
            const HalfSpace rest = other_side(half);
            const MeshData kept = cut_mesh(whole, {&half, 1}), cut = cut_mesh(whole, {&rest, 1});
            // Corners nearer than 1e-10 of the diagonal count as on the plane, of which up to 1.7
            // lie in the box.
            EXPECT_NEAR(volume_of_mesh(kept) + volume_of_mesh(cut), 1, 1.7 * off_plane);
            expect_sound(kept, 0);
            expect_sound(cut, 0);
            for (const glm::dvec3& point : kept.points) {
                EXPECT_GE(glm::dot(glm::normalize(half.normal), point - half.point), -off_plane);
            }
        }
    }
}

// Within rounding. (Of irregular meshes triangles of a cut may be so small that the plane of one
// is not that of the next.)
TEST(CutMesh, PartsOfAConvexMeshAreConvex) {
    const MeshData whole = kuhn(4);
    for (const HalfSpace& half : planes())
        EXPECT_NE(convexity(TetMesh(cut_mesh(whole, {&half, 1}), "kept")), Convexity::none);
}

// Where faces of the mesh lie in the plane nothing is cut.
TEST(CutMesh, PlanesAlongFacesMakeNoTets) {
    const MeshData whole = kuhn(4);
    const HalfSpace face{{.25, .1, .7}, {-3, 0, 0}}, diagonal{{0, 0, .3}, {2, -2, 0}};
    EXPECT_EQ(cut_mesh(whole, {&face, 1}).tets.size(), whole.tets.size() / 4);
    EXPECT_EQ(cut_mesh(whole, {&diagonal, 1}).tets.size(), whole.tets.size() / 2);
}

TEST(CutMesh, ScalarsAreLinearAndConstantsStay) {
    const auto linear = [](const glm::dvec3& p) { return 3 * p.x - p.y + .5 * p.z; };
    MeshData whole = test::split_box(7, 600, .05, linear);
    whole.point_scalars.push_back({"constant", std::vector<double>(whole.points.size(), .1)});
    const std::vector<HalfSpace> wedge{{{.5, .5, .5}, {.3, -.7, .2}}, {{.5, .4, .5}, {1, .2, 0}}};
    const MeshData kept = cut_mesh(whole, wedge);
    ASSERT_FALSE(kept.tets.empty());
    for (std::size_t i = 0; i < kept.points.size(); ++i) {
        EXPECT_NEAR(kept.point_scalars[0].values[i], linear(kept.points[i]), 1e-14);
        EXPECT_EQ(kept.point_scalars[1].values[i], .1);
    }
}

// Every part of a tet without a value is without one, and no other tet is.
TEST(CutMesh, TetsWithoutValueStayWithout) {
    MeshData whole = kuhn(4);
    for (std::size_t i = 0; i < whole.points.size(); i += 7)
        whole.point_scalars[0].values[i] = i % 2 == 0 ? NAN : -INFINITY;
    const auto volume_without = [](const MeshData& mesh) {
        double sum = 0;
        for (const Tet& tet : mesh.tets) {
            const bool without = std::ranges::any_of(tet, [&](std::int32_t corner) {
                return !std::isfinite(
                    mesh.point_scalars[0].values[static_cast<std::size_t>(corner)]);
            });
            if (without) sum += test::volume_of_tet(mesh, tet);
        }
        return sum;
    };
    for (const HalfSpace& half : planes()) {
        const HalfSpace rest = other_side(half);
        EXPECT_NEAR(volume_without(cut_mesh(whole, {&half, 1})) +
                        volume_without(cut_mesh(whole, {&rest, 1})),
                    volume_without(whole), 1.7 * off_plane);
    }
}

// Far from the origin roundings are large: 1e7 times an epsilon of 1e-16, and the plane's share.
TEST(CutMesh, FarMeshesStaySound) {
    MeshData whole = kuhn(4);
    for (glm::dvec3& point : whole.points) point += glm::dvec3(1e7, -3e6, 2e5);
    for (HalfSpace half : planes()) {
        half.point += glm::dvec3(1e7, -3e6, 2e5);
        expect_sound(cut_mesh(whole, {&half, 1}), 0);
    }
}

TEST(CutMesh, AClipThatCutsNothingCostsNothing) {
    const auto mesh = std::make_shared<const SceneMesh>(scene_mesh(kuhn(2)));
    EXPECT_EQ(clipped_mesh(mesh, {{}, ClipBox{{0, 0, 0}, {1, 1, 1}}}, false, "mesh"), mesh);
    EXPECT_EQ(clipped_mesh(mesh, {{{{1.1, 0, 0}, {1, 0, 0}}}, {}}, false, "mesh"), nullptr);
    EXPECT_EQ(clipped_mesh(mesh, {{{{1, 0, 0}, {1, 0, 0}}}, {}}, false, "mesh"), nullptr);
}

class Clipped : public ProjectionTest {
  protected:
    // Errors in 1/255: those of the same mesh without a clip (conforming_test.cpp), and cut tets
    // have faces as oblique as the plane.
    void expect_traced(const std::shared_ptr<const SceneMesh>& mesh, double bound,
                       const std::string& name) {
        Scene scene = projection_scene(
            TransferFunction::linear({knot(.1, {1, .2, 0}, .3), knot(.4, {1, 1, 0}, 2),
                                      knot(.45, {0, 1, .5}, .1), knot(1, {0, .3, 1}, 4)}),
            60, 45);
        scene.camera->center = {.5, .5, .5};
        scene.camera->up = {0, 1, .001};
        scene.camera->fov_y = 60;
        scene.camera->height = 1.6;
        for (const test::NamedClip& named : test::clips_of_unit_box()) {
            scene.clip = named.clip;
            const auto cut = clipped_mesh(mesh, scene.clip, scene.lighting.has_value(), "mesh");
            for (const glm::dvec3 eye : {glm::dvec3(1.6, -.5, .9), glm::dvec3(.31, .42, .63)}) {
                for (const auto projection : {Projection::perspective, Projection::orthographic}) {
                    scene.camera->projection = projection;
                    scene.camera->eye = eye;
                    const Image truth = trace(*mesh, scene);
                    if (cut == nullptr) {
                        EXPECT_EQ(truth.rgba, Image(scene.width, scene.height).rgba) << named.name;
                        continue;
                    }
                    EXPECT_LE(image_error(project(*cut, scene, capabilities()), truth).all.linf,
                              bound)
                        << name << ", " << named.name << ", eye " << eye.x << ", projection "
                        << static_cast<int>(projection);
                }
            }
        }
    }
};

TEST_P(Clipped, KuhnsMeshMeetsTheTracer) {
    expect_traced(std::make_shared<const SceneMesh>(scene_mesh(kuhn(5))), .1, "kuhn");
}

TEST_P(Clipped, IrregularMeshMeetsTheTracer) {
    expect_traced(
        std::make_shared<const SceneMesh>(scene_mesh(test::split_box(3, 1500, .05, wave))), .1,
        "split");
}

INSTANTIATE_TEST_SUITE_P(BothEngines, Clipped, both_engines, engine_name);

}  // namespace
}  // namespace lamina
