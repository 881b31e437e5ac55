// SPDX-License-Identifier: Apache-2.0
// Meshes that VTK's writers cut into pieces are joined to the original mesh.
#include <sys/wait.h>

#include <glm/geometric.hpp>

#include <array>
#include <map>
#include <set>

#include "mesh/tet_mesh.h"
#include "mesh_files.h"

namespace lamina {
namespace {

using VtkPieces = testing::MeshFiles;
using Place = std::array<float, 3>;  // VTK cuts meshes in float32

std::map<Place, std::vector<double>> values_by_place(const MeshData& mesh) {
    std::map<Place, std::vector<double>> values;
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
        const glm::dvec3& p = mesh.points[i];
        auto& here =
            values[{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)}];
        for (const MeshScalar& scalar : mesh.point_scalars) here.push_back(scalar.values[i]);
    }
    return values;
}

double volume_of(const MeshData& mesh) {
    double sum = 0;
    for (const Tet& tet : mesh.tets) {
        const auto p = [&](std::size_t i) { return mesh.points[static_cast<std::size_t>(tet[i])]; };
        sum += glm::dot(glm::cross(p(1) - p(0), p(2) - p(0)), p(3) - p(0)) / 6;
    }
    return sum;
}

TEST_F(VtkPieces, MakeTheWholeMesh) {
    const int status = run_script("vtk_pieces.py");
    if (WEXITSTATUS(status) == 77) GTEST_SKIP() << "python3-vtk9 is not installed";
    ASSERT_EQ(status, 0);

    const MeshData whole = read_mesh(folder() / "whole.vtu");
    const TetMesh whole_mesh(MeshData(whole), "whole");
    EXPECT_EQ(whole.cells.merged_points, 0);
    ASSERT_TRUE(whole_mesh.findings().conforming());
    // The surface of 4 x 4 x 4 cubes, with two triangles a square.
    ASSERT_EQ(whole_mesh.findings().boundary_faces, 6 * 16 * 2);
    for (const char* const name : {"ghosts.pvtu", "plain.pvtu", "pieces.vtu"}) {
        SCOPED_TRACE(name);
        MeshData mesh = read_mesh(folder() / name);
        EXPECT_EQ(mesh.points.size(), whole.points.size());
        EXPECT_EQ(mesh.tets.size(), whole.tets.size());
        EXPECT_GT(mesh.cells.merged_points, 50);
        EXPECT_EQ(mesh.cells.ghosts > 0, std::string_view(name) == "ghosts.pvtu");
        EXPECT_EQ(mesh.cells.split, whole.cells.split);
        // In float32, coordinates up to 4 are off by 2.4e-7 at most, in each of three factors of a
        // volume.
        EXPECT_NEAR(volume_of(mesh) / volume_of(whole), 1, 1e-6);
        EXPECT_EQ(values_by_place(mesh), values_by_place(whole));
        ASSERT_EQ(mesh.cell_scalars.size(), 1u);
        const auto& cells = mesh.cell_scalars[0].values;
        EXPECT_EQ(std::multiset<double>(cells.begin(), cells.end()),
                  std::multiset<double>(whole.cell_scalars[0].values.begin(),
                                        whole.cell_scalars[0].values.end()));
        const TetMesh joined(std::move(mesh), name);
        EXPECT_TRUE(joined.findings().conforming());
        EXPECT_EQ(joined.findings().boundary_faces, whole_mesh.findings().boundary_faces);
        EXPECT_EQ(joined.findings().inverted, 0);
        EXPECT_EQ(joined.findings().unused_points, 0);
    }
}

}  // namespace
}  // namespace lamina
