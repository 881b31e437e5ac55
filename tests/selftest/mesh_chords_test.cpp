// SPDX-License-Identifier: Apache-2.0
#include "selftest/picture_bounds.h"

#include <gtest/gtest.h>

#include <cmath>

#include "selftest/case_makers.h"
#include "selftest/layered_box.h"

namespace lamina::selftest {
namespace {

SceneMesh mesh_of(MeshData data) {
    MeshScalar scalar = data.point_scalars.at(0);
    data.point_scalars.clear();
    return {TetMesh(std::move(data), "test"), scalar, false, {}};
}

// The chords of a box's tets add up to the box's chord, however it is divided.
TEST(MeshChords, AddUpToTheChordOfTheBox) {
    const SelftestScene scene = plain_scene("", "");
    const TransferFunction optics = optics_of({{0, {{1, 1, 1}, 1}}});
    const View view(*scene.scene.camera, 24, 18);
    for (const MeshData& data :
         {kuhn_tets(scene.box, 3), fan_tets(scene.box, 4), split_tets(scene.box, 20, .03, 1),
          shuffled(kuhn_tets(scene.box, 2), 3)}) {
        const SceneMesh mesh = mesh_of(data);
        EXPECT_EQ(mesh.mesh.findings().nonmanifold_faces, 0);
        EXPECT_EQ(mesh.mesh.findings().degenerate, 0);
        const MeshChords chords(mesh, view, 1e-6);
        for (const double column : {9., 12., 14.3}) {
            const View::Ray ray = view.ray(column, 8.7);
            const auto chord = box_chord(scene.box, ray, 0);
            ASSERT_TRUE(chord);
            const MeshChords::Along along = chords.along(ray, optics);
            // Tolerance: rounding of doubles, enlarged by flat tets that were split once or twice
            // (1e-3).
            EXPECT_NEAR(along.depth, chord->length(), 1e-11);
            EXPECT_LE(along.possible_depth.lo, along.depth);
            EXPECT_GE(along.possible_depth.hi, along.depth);
            EXPECT_GE(along.crossed, 1);
        }
    }
}

}  // namespace
}  // namespace lamina::selftest
