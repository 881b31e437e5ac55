// SPDX-License-Identifier: Apache-2.0
// Polyhedra in the two forms of VTK XML files, prisms, and cells that are left out.
#include <glm/geometric.hpp>

#include "bad_mesh_files.h"
#include "mesh/tet_mesh.h"

namespace lamina {
namespace {

using testing::make_vtu;
using testing::TestArray;
using testing::TestGrid;
using testing::with;
using Faces = std::vector<std::vector<int>>;

const Faces cube_faces{{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4},
                       {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};

std::string list(const std::string& name, const std::vector<int>& values) {
    std::string text;
    for (const int value : values) text += fmt::format("{} ", value);
    return fmt::format("<DataArray type=\"Int64\" Name=\"{}\" format=\"ascii\">{}</DataArray>",
                       name, text);
}

class Polyhedra : public testing::BadMeshFiles {
  protected:
    // A tet on a cube, which is a polyhedron; their common face is not shared.
    static TestGrid grid() {
        TestGrid grid;
        grid.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},  {0, 0, 1},
                       {1, 0, 1}, {1, 1, 1}, {0, 1, 1}, {.5, .5, 2}};
        grid.cells = {{10, {4, 5, 6, 8}}, {42, {0, 1, 2, 3, 4, 5, 6, 7}}};
        grid.point_arrays = {{"s", "Float64", 1, {0, 1, 2, 3, 4, 5, 6, 7, 8}}};
        grid.cell_arrays = {{"c", "Float64", 1, {1, 2}}};
        return grid;
    }

    // A file with a face stream of the second cell, as VTK writes it up to 9.3.
    static std::string stream_file(const TestGrid& grid, const Faces& faces) {
        std::vector<int> stream{static_cast<int>(faces.size())};
        for (const auto& face : faces) {
            stream.push_back(static_cast<int>(face.size()));
            stream.insert(stream.end(), face.begin(), face.end());
        }
        return with(make_vtu(grid), "</Cells>",
                    list("faces", stream) +
                        list("faceoffsets", {-1, static_cast<int>(stream.size())}) + "</Cells>");
    }

    // The arrays of VTK 9.4; the faces are listed from the last to the first.
    static std::string list_file(const TestGrid& grid, const Faces& faces) {
        std::vector<int> corners, ends, numbers;
        for (auto face = faces.rbegin(); face != faces.rend(); ++face) {
            corners.insert(corners.end(), face->begin(), face->end());
            ends.push_back(static_cast<int>(corners.size()));
            numbers.insert(numbers.begin(), static_cast<int>(numbers.size()));
        }
        return with(make_vtu(grid), "</Cells>",
                    list("face_connectivity", corners) + list("face_offsets", ends) +
                        list("polyhedron_to_faces", numbers) +
                        list("polyhedron_offsets", {0, static_cast<int>(numbers.size())}) +
                        "</Cells>");
    }
};

TEST_F(Polyhedra, AreCutFromTheMeanOfTheirPointsInBothForms) {
    const MeshData mesh = read("a.vtu", stream_file(grid(), cube_faces));
    ASSERT_EQ(mesh.tets.size(), 1u + 12);
    ASSERT_EQ(mesh.points.size(), 10u);
    EXPECT_EQ(mesh.points[9], glm::dvec3(.5));
    EXPECT_EQ(mesh.point_scalars[0].values[9], 3.5);
    EXPECT_EQ(mesh.cells.split, 1);
    EXPECT_EQ(mesh.cells.made_points, 1);
    EXPECT_EQ(mesh.cells.not_star_shaped, 0);
    EXPECT_EQ(mesh.cell_scalars[0].values[0], 1);
    EXPECT_EQ(mesh.cell_scalars[0].values[12], 2);
    // The face 4 5 6 7 is cut through its least index, as the hexahedron's would be.
    const TetMesh checked(MeshData(mesh), "mesh");
    EXPECT_EQ(checked.findings().boundary_faces, 3 + 11);
    EXPECT_EQ(checked.findings().inverted, 0);
    testing::expect_equal(read("b.vtu", list_file(grid(), cube_faces)), mesh);
}

// Each face of the cube has four points of its own, at the places of those that the tet has, too.
TEST_F(Polyhedra, FacesMayShareNoPoints) {
    TestGrid apart = grid();
    apart.cells[1].corners.clear();
    Faces faces;
    for (const auto& face : cube_faces) {
        auto& own = faces.emplace_back();
        for (const int corner : face) {
            own.push_back(static_cast<int>(apart.points.size()));
            apart.cells[1].corners.push_back(own.back());
            apart.points.push_back(glm::dvec3(apart.points[static_cast<std::size_t>(corner)]));
            apart.point_arrays[0].values.push_back(corner);
        }
    }
    MeshData mesh = read("a.vtu", stream_file(apart, faces));
    EXPECT_EQ(mesh.tets.size(), 1u + 12);
    EXPECT_EQ(mesh.cells.not_star_shaped, 0);
    EXPECT_LT(glm::distance(mesh.points.back(), glm::dvec3(.5)), 1e-14);
    // The tet's face is one of the cube's 12.
    EXPECT_EQ(TetMesh(std::move(mesh), "apart").findings().boundary_faces, 3 + 11);
}

TEST_F(Polyhedra, AreCountedIfTheyAreNotStarShapedOrNotClosed) {
    Faces open = cube_faces;
    open.pop_back();
    EXPECT_EQ(read("a.vtu", stream_file(grid(), open)).cells.not_star_shaped, 1);
    Faces twice = cube_faces;
    twice.push_back(twice.front());
    EXPECT_EQ(read("a.vtu", stream_file(grid(), twice)).cells.not_star_shaped, 1);
    // A prism over an L with long, thin arms: the mean of its points lies outside.
    TestGrid bent;
    for (const double z : {0., 1.}) {
        for (const auto& [x, y] :
             {std::pair{0., 0.}, {6., 0.}, {6., 1.}, {1., 1.}, {1., 6.}, {0., 6.}})
            bent.points.emplace_back(x, y, z);
    }
    Faces faces{{0, 1, 2, 3, 4, 5}, {6, 7, 8, 9, 10, 11}};
    for (int i = 0; i < 6; ++i) faces.push_back({i, (i + 1) % 6, 6 + (i + 1) % 6, 6 + i});
    bent.cells = {{10, {0, 1, 2, 6}}, {42, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}}};
    EXPECT_EQ(read("a.vtu", stream_file(bent, faces)).cells.not_star_shaped, 1);
    for (auto& point : bent.points) {  // arms of length 1: the mean (5/6, 5/6) lies inside
        point.x = std::min(point.x, 2.);
        point.y = std::min(point.y, 2.);
    }
    EXPECT_EQ(read("a.vtu", stream_file(bent, faces)).cells.not_star_shaped, 0);
}

TEST_F(Polyhedra, NameTheBadFace) {
    Faces faces = cube_faces;
    faces[2][1] = 9;
    expect_bad("a.vtu", stream_file(grid(), faces), {"cell 1", "point index 9", "0 to 8"});
    faces[2] = {0, 1};
    expect_bad("a.vtu", stream_file(grid(), faces), {"cell 1", "points of a face: found 2"});
    faces.resize(2);
    expect_bad("a.vtu", stream_file(grid(), faces), {"cell 1", "number of faces: found 2"});
    expect_bad("a.vtu", make_vtu(grid()), {"'faceoffsets'"});
    const std::string file = stream_file(grid(), cube_faces);
    expect_bad("a.vtu", with(file, ">-1 31 <", ">-1 -1 <"), {"faces", "found more"});
    expect_bad("a.vtu", with(file, ">6 4 0", ">7 4 0"), {"cell 1", "points of a face: found 0"});
    expect_bad("a.vtu", with(file, ">6 4 0", ">6 40 0"),
               {"cell 1", "points of a face: found 40", "31 numbers"});
    const std::string lists = list_file(grid(), cube_faces);
    expect_bad("a.vtu", with(lists, ">5 4 3", ">5 -4 3"), {"polyhedron_to_faces: found -4"});
    expect_bad("a.vtu", with(lists, ">4 8 12", ">4 3 12"), {"face_offsets", "found 3 after 4"});
    expect_bad("a.vtu", with(lists, ">0 6 <", ">7 6 <"), {"polyhedron_offsets", "found 7 after 0"});
}

TEST_F(Polyhedra, PrismsOverPentagonsAndHexagonsAreRead) {
    for (const int sides : {5, 6}) {
        TestGrid prism;
        prism.cells = {{sides == 5 ? 15 : 16, {}}};
        for (int i = 0; i < 2 * sides; ++i) {
            const double angle = 2 * M_PI * i / sides;
            prism.points.emplace_back(std::cos(angle), std::sin(angle), i / sides);
            prism.cells[0].corners.push_back(i);
        }
        const MeshData mesh = read("a.vtu", make_vtu(prism));
        double sum = 0;
        for (const Tet& tet : mesh.tets) {
            const auto p = [&](std::size_t i) {
                return mesh.points[static_cast<std::size_t>(tet[i])];
            };
            sum += glm::dot(glm::cross(p(1) - p(0), p(2) - p(0)), p(3) - p(0)) / 6;
        }
        EXPECT_NEAR(sum, sides / 2. * std::sin(2 * M_PI / sides), 1e-14);
        EXPECT_EQ(mesh.cells.split, 1);
        EXPECT_EQ(mesh.cells.not_star_shaped, 0);
    }
}

// vtkDataSetAttributes: HIDDENPOINT is 2; DUPLICATEPOINT, 1, hides nothing.
TEST_F(Polyhedra, CellsWithHiddenPointsAreLeftOut) {
    TestGrid both = grid();
    both.point_arrays.push_back({"vtkGhostType", "UInt8", 1, {0, 0, 0, 0, 1, 1, 1, 1, 2}});
    const MeshData mesh = read("a.vtu", stream_file(both, cube_faces));
    EXPECT_EQ(mesh.cells.ghosts, 1);
    EXPECT_EQ(mesh.point_scalars.size(), 1u);
    EXPECT_EQ(mesh.cell_scalars[0].values, std::vector<double>(12, 2));
    both.point_arrays[1].values = {2, 0, 0, 0, 1, 1, 1, 1, 1};
    const MeshData other = read("a.vtu", stream_file(both, cube_faces));
    EXPECT_EQ(other.cells.ghosts, 1);
    EXPECT_EQ(other.tets, (std::vector<Tet>{{4, 5, 6, 8}}));
}

// The mean goes over the file's cells, whatever tets they are cut into.
TEST_F(Polyhedra, CellDataAreAveragedOverWholeCells) {
    const MeshData mesh = read("a.vtu", stream_file(grid(), cube_faces));
    const MeshScalar* const only = only_array(mesh.cell_scalars);
    ASSERT_NE(only, nullptr);
    const MeshScalar mean =
        average_to_points(mesh.points.size(), mesh.tets, *only, mesh.cell_of_tet);
    EXPECT_EQ(mean.values, (std::vector<double>{2, 2, 2, 2, 1.5, 1.5, 1.5, 2, 1, 2}));
}

TEST(OnlyArray, IsAScalarOrAVectorButNotTwo) {
    EXPECT_EQ(only_array({}), nullptr);
    const std::vector<MeshScalar> vector{{"v", {1}}, {"v.x", {1}}, {"v.y", {1}}, {"v.z", {1}}};
    EXPECT_EQ(only_array(vector), &vector[0]);
    EXPECT_EQ(only_array({{"a", {1}}, {"b", {1}}}), nullptr);
}

}  // namespace
}  // namespace lamina
