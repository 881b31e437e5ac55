// SPDX-License-Identifier: Apache-2.0
// Meshes in several pieces, files and time steps.
#include "bad_mesh_files.h"
#include "mesh/tet_mesh.h"
#include "support/heard_warnings.h"

namespace lamina {
namespace {

using testing::make_vtu;
using testing::TestGrid;
using testing::VtuMaker;

class MeshPieces : public testing::BadMeshFiles {
  protected:
    test::HeardWarnings heard_;
    std::vector<std::string>& warnings_ = heard_.texts;
};

// Returns a unit cube from x on, whose points have the value 10 times their x.
TestGrid cube_at(double x) {
    TestGrid grid;
    for (int i = 0; i < 8; ++i) grid.points.emplace_back(x + (i & 1), i >> 1 & 1, i >> 2);
    grid.cells = {{11, {0, 1, 2, 3, 4, 5, 6, 7}}};
    testing::TestArray values{"value", "Float64", 1, {}};
    for (const auto& point : grid.points) values.values.push_back(10 * point.x);
    grid.point_arrays = {values};
    return grid;
}

std::string two_cubes() {
    return VtuMaker({"raw"}).file({cube_at(0), cube_at(1)});
}

std::string pvtu_of(const std::vector<std::string>& files) {
    std::string text = "<VTKFile type=\"PUnstructuredGrid\"><PUnstructuredGrid GhostLevel=\"0\">";
    for (const std::string& file : files) text += "<Piece Source=\"" + file + "\"/>";
    return text + "</PUnstructuredGrid></VTKFile>";
}

TEST_F(MeshPieces, ShareThePointsOfTheirCommonFace) {
    MeshData mesh = read("a.vtu", two_cubes());
    EXPECT_EQ(mesh.points.size(), 12u);
    EXPECT_EQ(mesh.cells.merged_points, 4);
    EXPECT_TRUE(warnings_.empty());
    for (std::size_t i = 0; i < 12; ++i)
        EXPECT_EQ(mesh.point_scalars[0].values[i], 10 * mesh.points[i].x);
    const TetMesh joined(std::move(mesh), "a.vtu");
    EXPECT_EQ(joined.findings().boundary_faces, 10 * 2);
}

TEST_F(MeshPieces, ZeroAndMinusZeroAreOnePlace) {
    TestGrid one = cube_at(-1), two = cube_at(0);
    for (auto& point : one.points) {
        if (point.x == 0) point.x = -0.0;
    }
    EXPECT_EQ(read("a.vtu", VtuMaker({"raw"}).file({one, two})).cells.merged_points, 4);
}

TEST_F(MeshPieces, WarnOfDifferentValuesAtSharedPoints) {
    TestGrid two = cube_at(1);
    two.point_arrays[0].values[0] = 77;
    const MeshData mesh = read("a.vtu", VtuMaker({"raw"}).file({cube_at(0), two}));
    ASSERT_EQ(warnings_.size(), 1u);
    EXPECT_NE(warnings_[0].find("a.vtu: Piece 2: 'value': found 1 points with other values"),
              std::string::npos)
        << warnings_[0];
    for (std::size_t i = 0; i < 12; ++i)
        EXPECT_EQ(mesh.point_scalars[0].values[i], 10 * mesh.points[i].x);
}

// Two points of one piece at one place are the two sides of a crack. Neither is merged with a point
// of another piece.
TEST_F(MeshPieces, PointsOfACrackStayApart) {
    TestGrid cracked = cube_at(0);
    const TestGrid more = cube_at(1);
    cracked.points.insert(cracked.points.end(), more.points.begin(), more.points.end());
    cracked.cells.push_back({11, {8, 9, 10, 11, 12, 13, 14, 15}});
    auto& values = cracked.point_arrays[0].values;
    values.insert(values.end(), more.point_arrays[0].values.begin(),
                  more.point_arrays[0].values.end());
    TestGrid above = cube_at(1);
    for (auto& point : above.points) point.z += 1;
    const MeshData mesh = read("a.vtu", VtuMaker({"raw"}).file({cracked, above}));
    EXPECT_EQ(mesh.cells.merged_points, 2);  // at x = 2; each place at x = 1 has two points
    EXPECT_EQ(read("b.vtu", VtuMaker({"raw"}).file({above, cracked})).cells.merged_points, 2);
    EXPECT_EQ(read("c.vtu", make_vtu(cracked)).points.size(), 16u);
}

TEST_F(MeshPieces, GhostCellsAreLeftOut) {
    TestGrid both = cube_at(0);
    const TestGrid more = cube_at(1);
    both.points.insert(both.points.end(), more.points.begin(), more.points.end());
    both.cells.push_back({11, {8, 9, 10, 11, 12, 13, 14, 15}});
    both.point_arrays.clear();
    both.cell_arrays = {{"id", "Int32", 1, {5, 6}}, {"vtkGhostType", "UInt8", 1, {0, 1}}};
    MeshData mesh = read("a.vtu", make_vtu(both));
    EXPECT_EQ(mesh.cells.ghosts, 1);
    EXPECT_EQ(mesh.tets.size(), 6u);
    ASSERT_EQ(mesh.cell_scalars.size(), 1u);
    EXPECT_EQ(mesh.cell_scalars[0].values, std::vector<double>(6, 5));
    both.cell_arrays[1] = {"vtkGhostLevels", "UInt8", 1, {2, 0}};
    EXPECT_EQ(read("b.vtu", make_vtu(both)).cell_scalars[0].values, std::vector<double>(6, 6));
    both.cell_arrays[1].values = {1, 1};
    expect_bad("c.vtu", make_vtu(both), {"2 ghost cells"});
}

TEST_F(MeshPieces, PvtuNamesItsFiles) {
    write("one.vtu", make_vtu(cube_at(0)));
    std::filesystem::create_directory(folder() / "parts");
    write("parts/two.vtu", make_vtu(cube_at(1), {"raw", true}));
    const MeshData mesh = read("a.pvtu", pvtu_of({"one.vtu", "parts/two.vtu"}));
    EXPECT_EQ(mesh.points.size(), 12u);
    const auto files = files_of_mesh(folder() / "a.pvtu");
    ASSERT_EQ(files.size(), 3u);
    EXPECT_EQ(files[2], folder() / "parts/two.vtu");
    EXPECT_TRUE(is_mesh_file(write("noname", pvtu_of({}))));

    expect_bad("b.pvtu", pvtu_of({}), {"no <Piece>"});
    expect_bad("b.pvtu", pvtu_of({"one.vtu", "./one.vtu"}), {"one.vtu", "twice"});
    expect_bad("b.pvtu", pvtu_of({"one.vtu", ""}), {"Piece 2", "Source"});
    write("b.pvtu", pvtu_of({std::string(300, 'a')}));  // too long for a file name
    expect_error([&] { read_mesh(folder() / "b.pvtu"); }, {"aaa", "no such file"});
    expect_bad("b.pvtu", pvtu_of({"one.vtu"}).substr(0, 80), {"XML"});
    write("b.pvtu", pvtu_of({"one.vtu", "none.vtu"}));
    expect_error([&] { read_mesh(folder() / "b.pvtu"); }, {"none.vtu"});
    write("b.pvtu", pvtu_of({"b.pvtu"}));
    expect_error([&] { read_mesh(folder() / "b.pvtu"); },
                 {"'PUnstructuredGrid'", "expected 'UnstructuredGrid'"});
}

TEST_F(MeshPieces, PvdHasStepsInTheOrderOfTime) {
    write("one.vtu", make_vtu(cube_at(0)));
    write("two.vtu", make_vtu(cube_at(1)));
    write("late.vtu", make_vtu(cube_at(7)));
    const std::string pvd =
        "<VTKFile type=\"Collection\" version=\"0.1\"><Collection>"
        "<DataSet timestep=\"2.5\" group=\"\" part=\"0\" file=\"late.vtu\"/>"
        "<DataSet timestep=\"-1e1\" part=\"0\" file=\"one.vtu\"/>"
        "<DataSet timestep=\"-10\" part=\"1\" file=\"two.vtu\"/></Collection></VTKFile>";
    const auto path = write("a.pvd", pvd);
    EXPECT_EQ(steps_of_mesh(path), 2);
    EXPECT_EQ(read_mesh(path).points.size(), 12u);
    EXPECT_EQ(read_mesh(path, 1).points[0].x, 7);
    EXPECT_EQ(files_of_mesh(path).size(), 4u);
    EXPECT_EQ(steps_of_mesh(folder() / "one.vtu"), 1);
    expect_error([&] { read_mesh(path, 2); }, {"a.pvd", "time", "found 2", "0 to 1"});
    expect_error([&] { read_mesh(folder() / "one.vtu", 1); }, {"one.vtu", "found 1"});
    expect_bad("b.pvd", testing::with(pvd, "2.5", "x"), {"DataSet 1", "timestep", "'x'"});
    expect_bad("b.pvd", testing::with(pvd, "two.vtu", "one.vtu"), {"timestep -10", "twice"});
    expect_bad("b.pvd", "<VTKFile type=\"Collection\"><Collection/></VTKFile>", {"no <DataSet>"});
}

}  // namespace
}  // namespace lamina
