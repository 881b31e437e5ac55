// SPDX-License-Identifier: Apache-2.0
// Codes of the cpu engine, compared pixel by pixel with those of OpenGL's programs and blending.
#include <algorithm>

#include "compositing/tree_shape.h"

#include "projection_fixture.h"
#include "support/split_box.h"

namespace lamina {
namespace {

// Returns how many components of two pictures differ in their code. OpenGL multiplies codes by a
// rounded 1 / M when it reads them back, which is off by 1.2e-7 of the value; codes lie 1.5e-5
// apart or more.
int differing(const Image& a, const Image& b) {
    int count = 0;
    for (std::size_t i = 0; i < a.rgba.size(); ++i)
        count += std::abs(a.rgba[i] - b.rgba[i]) > 1e-6f ? 1 : 0;
    return count;
}

class CpuCodes : public gl::GlTest {
  protected:
    CpuCodes()
        : mesh_(scene_mesh(test::split_box(11, 1000, 1e-2, [](const glm::dvec3& p) {
              return .5 + .5 * std::sin(5 * p.x + 3 * p.y) * std::cos(4 * p.z);
          }))) {}

    Scene scene(Target target) const {
        Scene scene = projection_scene(
            TransferFunction::linear(
                {knot(0, {.1, .2, .9}, .3), knot(.5, {.2, .9, .3}, .5), knot(1, {.9, .3, .1}, 3)}),
            101, 83);
        scene.camera->eye = {1.4, -.5, 1.3};
        scene.camera->center = {.5, .5, .5};
        scene.camera->fov_y = 60;
        scene.target = target;
        return scene;
    }
    // Returns how many codes may differ. Fragments agree to a few units in the last place of
    // float32, 1e-7. With M = 65535, one in 100 or 200 lies so near to a border between codes that
    // this changes its code, but of 33,532 components less than a hundred keep the difference. With
    // 8 bits it is one in 40,000.
    static int most_differing(int bits) { return bits > 8 ? 100 : 2; }
    // Returns the number of differing codes, of 101 * 83 * 4.
    int differing_of(const Scene& scene) const {
        return differing(project(mesh_, scene, cpu_capabilities()),
                         project(mesh_, scene, capabilities()));
    }

    SceneMesh mesh_;
};

TEST_F(CpuCodes, MatchOpenGlInEmulatedTargets) {
    for (const int bits : {3, 8, 13, 16}) {
        for (const AlphaRounding alpha :
             {AlphaRounding::truncate, AlphaRounding::nearest, AlphaRounding::stochastic}) {
            for (const OverRounding over : {OverRounding::separate, OverRounding::fused}) {
                Scene wanted = scene(Target::emulated);
                wanted.emulate = {bits, alpha, over, 99};
                EXPECT_LE(differing_of(wanted), most_differing(bits))
                    << bits << " bits, alpha " << name_of(alpha) << ", over " << name_of(over);
            }
        }
    }
}

TEST_F(CpuCodes, MatchOpenGlInDitheredTargets) {
    for (const Target target : {Target::fixed8, Target::fixed16, Target::emulated}) {
        for (const ProjectDither dither : {ProjectDither::alpha, ProjectDither::after_blend}) {
            Scene wanted = scene(target);
            wanted.project.dither = dither;
            wanted.emulate = {11, AlphaRounding::nearest, OverRounding::fused, 5};
            EXPECT_LE(differing_of(wanted), most_differing(target == Target::fixed8 ? 8 : 16))
                << name_of(target) << ", " << name_of(dither);
        }
    }
}

// In float32 scenes the cpu engine finds most faces of so many tets in float32. A colour of .1 lies
// half-way between two codes: 25.5 of 255, 6553.5 of 65535.
TEST_F(CpuCodes, MatchOpenGlInLargeMeshes) {
    const SceneMesh mesh = scene_mesh(test::split_box(5, 4000, 1e-2, ripples));
    ASSERT_GE(mesh.mesh.tets().size(), 10000);
    Scene wanted = scene(Target::emulated);
    wanted.transfer_function = TransferFunction::linear(
        {knot(0, {.1, .2, .9}, .3), knot(.5, {.1, .9, .3}, .5), knot(1, {.1, .3, .1}, 3)});
    for (const int bits : {8, 12, 16}) {
        for (const OverRounding over : {OverRounding::separate, OverRounding::fused}) {
            wanted.emulate = {bits, AlphaRounding::truncate, over, 1};
            const Image cpu = project(mesh, wanted, cpu_capabilities());
            const Image gl = project(mesh, wanted, capabilities());
            EXPECT_LE(differing(cpu, gl), most_differing(bits)) << bits << name_of(over);
            const double code = 255 / (std::exp2(bits) - 1);
            EXPECT_LE(image_error(cpu, gl).all.linf, 1.01 * code) << bits << name_of(over);
        }
    }
}

// Tets are cut by the near plane, and lists of tiles take several dispatches.
TEST_F(CpuCodes, MatchOpenGlFromInside) {
    Scene wanted = scene(Target::emulated);
    wanted.camera->eye = {.31, .42, .53};
    wanted.camera->center = {1, .6, .4};
    wanted.camera->fov_y = 110;
    wanted.emulate = {8, AlphaRounding::stochastic, OverRounding::separate, 7};
    EXPECT_LE(differing_of(wanted), most_differing(8));
    wanted.camera->projection = Projection::orthographic;
    wanted.camera->height = 2;
    EXPECT_LE(differing_of(wanted), most_differing(8));
}

// A single colour, in leaves of many tets and of few.
TEST_F(CpuCodes, MatchOpenGlInTrees) {
    Scene wanted = scene(Target::emulated);
    wanted.transfer_function =
        TransferFunction::linear({knot(0, {1, .5, .2}, .1), knot(1, {1, .5, .2}, 1)});
    for (const int bits : {8, 16}) {
        for (const AlphaRounding alpha : {AlphaRounding::nearest, AlphaRounding::stochastic}) {
            for (const std::vector<int>& factors :
                 {std::vector{1}, std::vector{7}, std::vector{3, 4, 2}}) {
                wanted.emulate = {bits, alpha, OverRounding::separate, 3};
                wanted.project.tree =
                    TreeSettings{.factors = factors, .nodes = NodeArithmetic::fixed};
                EXPECT_LE(differing_of(wanted), 4 * most_differing(bits))
                    << bits << " bits, alpha " << name_of(alpha) << ", tree " << to_text(factors);
            }
        }
    }
}

// The cpu engine's nodes round as llvmpipe's blending unit does, and OpenGL's to the nearest code:
// at each of three children and three of theirs the results may lie half a code apart.
TEST_F(CpuCodes, AreNearOpenGlInTreesDitheredAfterTheBlend) {
    Scene wanted = scene(Target::fixed16);
    wanted.transfer_function =
        TransferFunction::linear({knot(0, {1, .5, .2}, .01), knot(1, {1, .5, .2}, .1)});
    wanted.project.dither = ProjectDither::after_blend;
    wanted.project.tree = TreeSettings{.factors = {3, 3}, .nodes = NodeArithmetic::fixed};
    EXPECT_LE(image_error(project(mesh_, wanted, cpu_capabilities()),
                          project(mesh_, wanted, capabilities()))
                      .all.linf *
                  257,
              6);
}

TEST_F(CpuCodes, MatchOpenGlInNativeTargets) {
    EXPECT_LE(differing_of(scene(Target::fixed8)), most_differing(8));
    EXPECT_LE(differing_of(scene(Target::fixed16)), most_differing(16));
    // Values are truncated to 11 bits after each fragment. They are on a border as often as codes
    // of 11 bits, and later fragments do not undo a difference.
    EXPECT_LE(differing_of(scene(Target::float16)), 1000);
}

}  // namespace
}  // namespace lamina
