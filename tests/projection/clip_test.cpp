// SPDX-License-Identifier: Apache-2.0
// Clipped meshes: the two meshes on both sides of a plane, and their pictures against the tracer,
// which clips rays instead of meshes.
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

// Returns planes through points, edges and faces of Kuhn's mesh of 4^3 cells, and random ones.
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

// Distance from the plane within which corners count as on it: 1e-10 of the unit box's diagonal.
constexpr double off_plane = 1e-10 * 1.74;

TEST(CutMesh, BothSidesTogetherAreTheWhole) {
    for (const MeshData& whole : {kuhn(4), test::split_box(7, 600, .05, wave)}) {
        for (const HalfSpace& half : planes()) {
            const HalfSpace rest = other_side(half);
            const MeshData kept = cut_mesh(whole, {&half, 1}), cut = cut_mesh(whole, {&rest, 1});
            // Corners within off_plane count as on the plane, whose area in the box is at most 1.7.
            EXPECT_NEAR(volume_of_mesh(kept) + volume_of_mesh(cut), 1, 1.7 * off_plane);
            expect_sound(kept, 0);
            expect_sound(cut, 0);
            for (const glm::dvec3& point : kept.points) {
                EXPECT_GE(glm::dot(glm::normalize(half.normal), point - half.point), -off_plane);
            }
        }
    }
}

// The convexity is that within rounding. (Irregular meshes are not tested: triangles of their cuts
// may be so small that neighbours lie in different planes.)
TEST(CutMesh, PartsOfAConvexMeshAreConvex) {
    const MeshData whole = kuhn(4);
    for (const HalfSpace& half : planes())
        EXPECT_NE(convexity(TetMesh(cut_mesh(whole, {&half, 1}), "kept")), Convexity::none);
}

// A plane along faces of the mesh cuts no tet.
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

// A piece of a tet has no value if, and only if, the tet has none.
TEST(CutMesh, TetsWithoutValueStayWithoutValue) {
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

// Far from the origin roundings are large: 1e7 times an epsilon of 1e-16, beside those of the
// plane.
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
    // `bound`: in 1/255. Errors are those of the same mesh without a clip (conforming_test.cpp),
    // though cut tets have faces as oblique as the plane.
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

INSTANTIATE_TEST_SUITE_P(Engines, Clipped, every_engine, engine_name);

}  // namespace
}  // namespace lamina
