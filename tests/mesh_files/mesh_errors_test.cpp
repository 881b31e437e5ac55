// SPDX-License-Identifier: Apache-2.0
// Bad mesh files of every kind. Each error is one line that names the file, what was found and what
// was expected.
#include <sys/resource.h>

#include <random>

#include "bad_mesh_files.h"

namespace lamina {
namespace {

using testing::all_vtu_styles;
using testing::make_vtu;
using testing::mixed_grid;
using testing::TestGrid;
using testing::VtkMaker;
using testing::VtuStyle;
using testing::with;

using MeshErrors = testing::BadMeshFiles;

TEST_F(MeshErrors, NameMissingFilesAndFolders) {
    for (const std::string name : {"none.vtu", "none.vtk", "none.node", "none.ele"}) {
        expect_error([&] { read_mesh(folder() / name); }, {name, "no such file"});
    }
    std::filesystem::create_directory(folder() / "dir.vtu");
    expect_error([&] { read_mesh(folder() / "dir.vtu"); }, {"dir.vtu", "not a regular file"});
}

TEST_F(MeshErrors, RefuseFilesOfAnotherKind) {
    expect_bad("a.vtu", "", {"not a VTK XML file"});
    expect_bad("a.vtu", "solid cube", {"not a VTK XML file"});
    expect_bad("a.vtu", "<VTKFile type=\"PolyData\"></VTKFile>", {"surface (PolyData)"});
    expect_bad("a.vtu", "<VTKFile type=\"ImageData\"></VTKFile>", {"'ImageData'"});
    expect_bad("a.vtu", "<VTKFile type=\"UnstructuredGrid\"></VTKFile>", {"<UnstructuredGrid>"});
    expect_bad("a.vtu", "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid/></VTKFile>",
               {"<Piece>"});
    expect_bad("a.vtk", "", {"not a legacy VTK file"});
    expect_bad("a.vtk", "# vtk DataFile Version 9.0\n\nASCII\n", {"version", "'9.0'"});
    expect_bad("a.vtk", "# vtk DataFile Version 3.0\ntitle\nHEX\n", {"'hex'", "ASCII or BINARY"});
    expect_bad("a.vtk", "# vtk DataFile Version 3.0\n\nASCII\nDATASET POLYDATA\n",
               {"line 4", "polydata", "UNSTRUCTURED_GRID"});
}

TEST_F(MeshErrors, NameTheBadCell) {
    const auto both = [&](const TestGrid& grid, std::initializer_list<std::string> parts) {
        expect_bad("a.vtu", make_vtu(grid), parts);
        expect_bad("a.vtu", make_vtu(grid, {"raw", true}), parts);
        expect_bad("a.vtk", VtkMaker(false, false).file(grid), parts);
        expect_bad("a.vtk", VtkMaker(true, true).file(grid), parts);
    };
    TestGrid grid = mixed_grid();
    grid.cells[2].corners[5] = 24;
    both(grid, {"cell 2", "index 24", "0 to 23"});
    grid.cells[2].corners[5] = -1;
    both(grid, {"cell 2", "index -1"});
    grid = mixed_grid();
    grid.cells[3].corners[0] = 2000000000;
    both(grid, {"cell 3", "index 2000000000"});
    grid = mixed_grid();
    grid.cells[5].type = 41;
    both(grid, {"cell 5", "convex point set (VTK cell type 41)", "polyhedra"});
    grid.cells[5].type = 79;
    both(grid, {"cell 5", "Bezier hexahedron (VTK cell type 79)", "Lagrange"});
    grid.cells[5].type = 99;
    both(grid, {"cell 5", "unknown type (VTK cell type 99)", "docs/meshes.md"});
    grid = mixed_grid();
    grid.cells[0].corners.pop_back();
    both(grid, {"cell 0", "tetrahedron", "found 3 points, expected 4"});
    grid = mixed_grid();
    grid.cells = {{3, {0, 1}}, {5, {0, 1, 2}}};
    grid.cell_arrays.clear();
    both(grid, {"2 cells", "without volume"});
    grid.cells.clear();
    both(grid, {"no cells"});
    grid = TestGrid();
    both(grid, {"no points"});
}

// Takes no memory for what a small file promises but cannot hold.
TEST_F(MeshErrors, RefuseHugeCountsWithoutTakingMemory) {
    rusage before{}, after{};
    getrusage(RUSAGE_SELF, &before);
    for (const std::string count : {"1000000000", "4000000000000000000"}) {
        for (const VtuStyle& style : all_vtu_styles()) {
            const std::string good = make_vtu(mixed_grid(), style);
            expect_bad("a.vtu",
                       with(good, "NumberOfCells=\"8\"", "NumberOfCells=\"" + count + "\""),
                       {"types"});
            expect_bad("a.vtu",
                       with(good, "NumberOfPoints=\"24\"", "NumberOfPoints=\"" + count + "\""),
                       {"Points"});
        }
        for (const bool binary : {false, true}) {
            const std::string good = VtkMaker(binary, false).file(mixed_grid());
            expect_bad("a.vtk", with(good, "CELLS 8 48", "CELLS " + count + " 48"), {"CELLS"});
            expect_bad("a.vtk", with(good, "CELLS 8 48", "CELLS 8 " + count), {"CELLS"});
            expect_bad("a.vtk", with(good, "POINTS 24", "POINTS " + count), {"POINTS"});
            expect_bad("a.vtk", with(good, "CELL_TYPES 8", "CELL_TYPES " + count), {"CELL_TYPES"});
            expect_bad("a.vtk", with(good, "region 1 8", "region 1 " + count), {"region"});
            expect_bad("a.vtk", with(good, "region 1 8", "region " + count + " 8"), {"region"});
            expect_bad("a.vtk", with(good, "POINT_DATA 24", "POINT_DATA " + count), {"pressure"});
            const std::string five = VtkMaker(binary, true).file(mixed_grid());
            expect_bad("a.vtk", with(five, "CELLS 9 40", "CELLS " + count + " 40"), {"OFFSETS"});
            expect_bad("a.vtk", with(five, "CELLS 9 40", "CELLS 9 " + count), {"CONNECTIVITY"});
        }
        write("a.ele", count + " 4 0\n1 1 2 3 4\n");
        expect_bad("a.node", "4 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n", {"line 1", count});
        expect_bad("a.node", count + " 3 0 0\n1 0 0 0\n", {"line 1", count});
    }
    getrusage(RUSAGE_SELF, &after);
    // In kilobytes; a billion tets would take more than ten million.
    EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 1'000'000);
}

TEST_F(MeshErrors, NameTheFlawOfALegacyVtkFile) {
    const std::string good = VtkMaker(false, false).file(mixed_grid());
    expect_bad("a.vtk", with(good, "POINTS 24 double", "POINTS -24 double"),
               {"line 8", "POINTS", "'-24'"});
    expect_bad("a.vtk", with(good, "POINTS 24 double", "POINTS 24 quaternion"), {"'quaternion'"});
    expect_bad("a.vtk", with(good, "POINTS 24 double", "POINTS 24 string"), {"POINTS", "numbers"});
    expect_bad("a.vtk", with(good, "POINTS 24", "POINTS 23"), {"line", "keyword"});
    expect_bad("a.vtk", with(good, "POINTS 24", "POINTS 25"), {"POINTS", "'METADATA'"});
    expect_bad("a.vtk", with(good, "CELLS 8 48", "CELLS 7 48"), {"CELLS"});
    expect_bad("a.vtk", with(good, "CELL_TYPES 8", "CELL_TYPES 7"), {"keyword"});
    expect_bad("a.vtk", with(good, "LOOKUP_TABLE default", ""), {"LOOKUP_TABLE"});
    expect_bad("a.vtk", with(good, "POINT_DATA 24", "POINT_DATA 23"), {"keyword"});
    expect_bad("a.vtk", with(good, "CELL_TYPES 8\n10", "CELL_TYPES 8\n10 x"), {"'x'"});
    expect_bad("a.vtk", with(good, "region 1 8", "region 1 7"), {"'region'", "7", "expected 8"});
    expect_bad("a.vtk", good + "POINTS 24 double\n", {"second POINTS"});
    expect_bad("a.vtk", good + "SHAPES 24\n", {"'shapes'"});
    const std::string head = good.substr(0, good.find("POINTS"));
    expect_bad("a.vtk", head, {"no POINTS"});
    expect_bad("a.vtk", good.substr(0, good.find("CELLS ")), {"no CELLS"});
    expect_bad("a.vtk", good.substr(0, good.find("CELL_TYPES")), {"no CELL_TYPES"});
    const std::string five = VtkMaker(false, true).file(mixed_grid());
    expect_bad("a.vtk", with(five, "OFFSETS", "ENDS"), {"'ends'", "OFFSETS"});
    expect_bad("a.vtk", with(five, "OFFSETS vtktypeint64\n0", "OFFSETS vtktypeint64\n1"),
               {"OFFSETS", "found 1", "expected 0"});
    expect_bad("a.vtk", with(five, "OFFSETS vtktypeint64\n0 4 7", "OFFSETS vtktypeint64\n0 40 7"),
               {"offsets", "7", "cell 1"});
    expect_bad("a.vtk", with(five, "OFFSETS vtktypeint64", "OFFSETS float"), {"integers"});
    const std::string list = "CELLS 8 48\n4 0 1 2 4 3";
    expect_bad("a.vtk", with(good, list, "CELLS 8 48\n400 0 1 2 4 3"), {"CELLS", "cell 0"});
    expect_bad("a.vtk", with(good, list, "CELLS 8 48\n-4 0 1 2 4 3"), {"CELLS", "cell 0"});
}

TEST_F(MeshErrors, NameTheFlawOfATetGenFile) {
    const std::string nodes = "4 3 1 0\n1 0 0 0 5\n2 1 0 0 5\n3 0 1 0 5\n4 0 0 1 5\n";
    const std::string tets = "2 4 0\n1 1 2 3 4\n2 4 3 2 1\n";
    const auto bad_node = [&](const std::string& text, std::initializer_list<std::string> parts) {
        write("a.ele", tets);
        expect_bad("a.node", text, parts);
    };
    const auto bad_ele = [&](const std::string& text, std::initializer_list<std::string> parts) {
        write("a.node", nodes);
        expect_bad("a.ele", text, parts);
    };
    bad_node("", {"no numbers"});
    bad_node("# nothing\n\n", {"no numbers"});
    bad_node("0 3 0 0\n", {"no points"});
    bad_node("-4 3 0 0\n", {"line 1", "number of points", "-4"});
    bad_node("4.5 3 0 0\n", {"line 1", "number of points", "'4.5'"});
    bad_node("4 2 0 0\n1 0 0\n", {"dimension", "found 2", "expected 3"});
    bad_node("4 3 1 2\n", {"boundary markers"});
    bad_node("4 3 999999999 0\n", {"999999999 attributes"});
    bad_node(with(nodes, "3 0 1 0 5", "3 0 1 0"), {"line 4", "attribute", "the end of the line"});
    bad_node(with(nodes, "3 0 1 0 5", "3 0 1 0 5 6"), {"line 4", "'6'", "after the point"});
    bad_node(with(nodes, "3 0 1 0 5", "3 0 one 0 5"), {"line 4", "coordinate", "'one'"});
    bad_node(with(nodes, "3 0 1 0 5", "5 0 1 0 5"), {"line 4", "found 5", "expected 3"});
    bad_node(with(nodes, "1 0 0 0 5", "2 0 0 0 5"), {"line 2", "found 2", "expected 0 or 1"});
    bad_node(with(nodes, "4 0 0 1 5\n", ""), {"found 3 points", "expected 4"});
    bad_node(nodes + "5 0 0 1 5\n", {"line 6", "'5'", "4 points promised"});
    bad_ele("", {"no numbers"});
    bad_ele("0 4 0\n", {"no tetrahedra"});
    bad_ele(with(tets, "2 4 0", "2 8 0"), {"line 1", "found 8", "4 or 10"});
    bad_ele(with(tets, "2 4 0", "2 4 1"), {"line 2", "attribute", "the end of the line"});
    bad_ele(with(tets, "4 3 2 1", "5 3 2 1"), {"line 3", "found 5", "1 to 4"});
    bad_ele(with(tets, "4 3 2 1", "0 3 2 1"), {"line 3", "found 0", "1 to 4"});
    bad_ele(with(tets, "4 3 2 1", "4 3 2"), {"line 3", "the end of the line"});
    bad_ele(with(tets, "2 4 3 2 1\n", ""), {"found 1 tetrahedra", "expected 2"});
    std::filesystem::remove(folder() / "a.node");
    expect_bad("a.ele", tets, {"a.node", "no such file", "a.ele"});
    std::filesystem::remove(folder() / "a.ele");
    expect_bad("a.node", nodes, {"a.ele", "no such file", "a.node"});
}

// A file that is cut off anywhere gives an error, or is read if only scalars are missing.
TEST_F(MeshErrors, RefuseFilesTruncatedAnywhereInTheMesh) {
    for (const VtuStyle& style : {VtuStyle{"ascii"}, VtuStyle{"raw", true}, VtuStyle{"base64"}}) {
        const std::string good = make_vtu(mixed_grid(), style);
        const std::size_t end = good.rfind("</VTKFile>");
        for (std::size_t length = 0; length < end; length += end / 61) {
            SCOPED_TRACE(length);
            expect_bad("a.vtu", good.substr(0, length), {});
        }
    }
    for (const bool binary : {false, true}) {
        const std::string good = VtkMaker(binary, binary).file(mixed_grid());
        // The file is valid without its cell data, which come last.
        const std::size_t end = good.find("CELL_DATA"), points = good.find("POINT_DATA");
        for (std::size_t length = 0; length < end; length += end / 61) {
            const std::string some = good.substr(0, length);
            if (length < points - 10) {
                expect_bad("a.vtk", some, {});
            } else {
                expect_survives("a.vtk", some);
            }
        }
    }
}

// A file of any format with random bytes changed gives an Error, or a mesh with valid indices.
TEST_F(MeshErrors, RefuseDamagedFilesUnlessTheMeshIsValid) {
    std::mt19937 random(4);
    std::vector<std::pair<std::string, std::string>> files;
    for (const VtuStyle& style : all_vtu_styles()) {
        files.emplace_back("a.vtu", make_vtu(mixed_grid(), style));
    }
    for (int i = 0; i < 4; ++i) {
        files.emplace_back("a.vtk", VtkMaker(i % 2 != 0, i / 2 != 0).file(mixed_grid()));
    }
    write("b.ele", "2 4 1\n1 1 2 3 4 9\n2 4 3 2 1 9\n");
    files.emplace_back("b.node", "4 3 1 0\n1 0 0 0 5\n2 1 0 0 5\n3 0 1 0 5\n4 0 0 1 5\n");
    constexpr char likely[] = "0123456789-+.e \n\"<>=_AZ\x00\x01\x7f\xff";
    for (const auto& [name, good] : files) {
        for (int round = 0; round < 15; ++round) {
            std::string bad = good;
            const int changes = 1 + static_cast<int>(random() % 4);
            for (int i = 0; i < changes; ++i)
                bad[random() % bad.size()] = likely[random() % (sizeof likely - 1)];
            expect_survives(name, bad);
        }
    }
    EXPECT_GT(refused_, 100);  // some files are refused, some still read
    EXPECT_GT(read_, 20);
}

}  // namespace
}  // namespace lamina
