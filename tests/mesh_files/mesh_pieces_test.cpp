// SPDX-License-Identifier: Apache-2.0
// Meshes in several pieces, files and time steps.
#include <algorithm>
#include <numeric>
#include <random>

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

TEST_F(MeshPieces, KeepTheirOwnValuesAtSharedPlaces) {
    TestGrid two = cube_at(1), three = cube_at(2);
    two.point_arrays[0].values[0] = 77;
    MeshData mesh = read("a.vtu", VtuMaker({"raw"}).file({cube_at(0), two, three}));
    EXPECT_TRUE(warnings_.empty());
    EXPECT_EQ(mesh.cells.merged_points, 3 + 4);
    ASSERT_EQ(mesh.points.size(), 17u);
    ASSERT_EQ(mesh.point_scalars[0].values.size(), 17u);
    for (std::size_t i = 0; i < 17; ++i)
        EXPECT_EQ(mesh.point_scalars[0].values[i], i == 8 ? 77 : 10 * mesh.points[i].x);
    EXPECT_EQ(mesh.points[8], glm::dvec3(1, 0, 0));
    const TetMesh joined(std::move(mesh), "a.vtu");
    EXPECT_EQ(joined.findings().boundary_faces, 14 * 2);
    EXPECT_EQ(joined.findings().copies, 1);
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

// Eight cubes share no points, and their points are in random orders, so that the least index of a
// face is another one in each of its two cubes. Each cell type is cut as if the points were shared.
TEST_F(MeshPieces, CellsThatShareNoPointsAreCutAlike) {
    std::mt19937 random(4);
    TestGrid grid;
    for (int cell = 0; cell < 8; ++cell) {
        const glm::dvec3 from(cell & 1, cell >> 1 & 1, cell >> 2);
        std::vector<int> corners(8);
        std::iota(corners.begin(), corners.end(), static_cast<int>(grid.points.size()));
        std::shuffle(corners.begin(), corners.end(), random);
        grid.points.resize(grid.points.size() + 8);
        for (std::size_t i = 0; i < 8; ++i) {
            const glm::dvec3 corner(i & 1, i >> 1 & 1, i >> 2);
            grid.points[static_cast<std::size_t>(corners[i])] = from + corner;
        }
        if (cell % 2 == 0) {
            grid.cells.push_back({11, corners});
            continue;
        }
        // Two wedges (vtkWedge.h), which share no points with one another either.
        for (int half = 0; half < 2; ++half) {
            std::vector<int> wedge;
            for (const std::size_t i : half == 0 ? std::array<std::size_t, 6>{0, 2, 1, 4, 6, 5}
                                                 : std::array<std::size_t, 6>{1, 2, 3, 5, 6, 7}) {
                wedge.push_back(static_cast<int>(grid.points.size()));
                grid.points.push_back(
                    glm::dvec3(grid.points[static_cast<std::size_t>(corners[i])]));
            }
            grid.cells.push_back({13, wedge});
        }
    }
    MeshData mesh = read("a.vtu", make_vtu(grid));
    ASSERT_EQ(mesh.tets.size(), 8u * 6);
    const TetMesh joined(std::move(mesh), "a.vtu");
    EXPECT_EQ(joined.findings().boundary_faces, 24 * 2);
    EXPECT_EQ(joined.findings().folded_faces, 0);
    EXPECT_EQ(joined.findings().degenerate, 0);
    EXPECT_EQ(joined.findings().unused_points, 4 * 8);  // those of the cubes that are wedges
}

// Two curved hexahedra of 20 points share none. The second is turned, so that their common face has
// other numbers in it. Their values differ by 1: so do those of the point that each cell makes in
// the middle of the face. Each face of a cell is cut into eight triangles.
TEST_F(MeshPieces, CurvedCellsThatShareNoPointsAreCutAlike) {
    constexpr int edges[12][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6},
                                  {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
    TestGrid grid;
    testing::TestArray values{"value", "Float64", 1, {}};
    for (int cell = 0; cell < 2; ++cell) {
        std::vector<glm::dvec3> places;
        for (int i = 0; i < 8; ++i) {
            const glm::dvec3 local((i & 1) ^ (i >> 1 & 1), i >> 1 & 1, i >> 2);
            places.push_back(cell == 0 ? local : glm::dvec3(1 + local.y, local.z, local.x));
        }
        for (const auto& [a, b] : edges)
            places.push_back(
                .5 * (places[static_cast<std::size_t>(a)] + places[static_cast<std::size_t>(b)]));
        testing::TestCell added{25, {}};
        for (const glm::dvec3& p : places) {
            added.corners.push_back(static_cast<int>(grid.points.size()));
            grid.points.push_back(p + .1 * glm::dvec3(p.y * (1 - p.z / 3), p.x * p.z, p.y * p.y));
            values.values.push_back(3 * p.x + p.y * p.z + cell);
        }
        grid.cells.push_back(added);
    }
    grid.point_arrays = {values};
    MeshData mesh = read("a.vtu", make_vtu(grid));
    EXPECT_EQ(mesh.points.size(), 2u * 27);
    const std::vector<double> of_points = mesh.point_scalars[0].values;
    const TetMesh joined(std::move(mesh), "a.vtu");
    EXPECT_EQ(joined.findings().boundary_faces, 10 * 8);
    EXPECT_EQ(joined.findings().copies, 9);
    EXPECT_EQ(joined.findings().folded_faces, 0);
    EXPECT_EQ(count_jumps(joined, of_points), 8);
    for (std::size_t i = 27; i < 54; ++i) {
        const auto first = static_cast<std::size_t>(joined.place(static_cast<std::int32_t>(i)));
        if (first != i) {
            EXPECT_NEAR(std::abs(of_points[i] - of_points[first]), 1, 1e-14);
        }
    }
}

// The second cube's points are off by 1e-9: its face has other places, and after joining the same.
TEST_F(MeshPieces, PointsNearEachOtherJoinOnRequest) {
    TestGrid grid = cube_at(0), more = cube_at(1);
    for (auto& point : more.points) point += 1e-9;
    grid.points.insert(grid.points.end(), more.points.begin(), more.points.end());
    grid.cells.push_back({11, {8, 9, 10, 11, 12, 13, 14, 15}});
    auto& values = grid.point_arrays[0].values;
    values.insert(values.end(), more.point_arrays[0].values.begin(),
                  more.point_arrays[0].values.end());
    const auto faces = [&](double join) {
        return TetMesh(read_mesh(folder() / "a.vtu", 0, join), "a.vtu").findings().boundary_faces;
    };
    write("a.vtu", make_vtu(grid));
    EXPECT_EQ(faces(0), 2 * 12);
    EXPECT_EQ(faces(1e-9), 2 * 12);  // sqrt(3) times 1e-9 apart
    EXPECT_TRUE(warnings_.empty());
    EXPECT_EQ(faces(2e-9), 2 * 10);
    ASSERT_EQ(warnings_.size(), 1u);
    EXPECT_NE(warnings_[0].find("a.vtu: mesh.join: 4 points took the place of an earlier one, up "
                                "to 1.73e-09 away"),
              std::string::npos)
        << warnings_[0];
    write("a.vtu", VtuMaker({"raw"}).file({cube_at(0), more}));
    EXPECT_EQ(faces(0), 2 * 12);
    EXPECT_EQ(faces(2e-9), 2 * 10);
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
