// SPDX-License-Identifier: Apache-2.0
// A mesh that is written in every format and coding is read as the same mesh, bit for bit.
#include <algorithm>

#include "mesh_files.h"

namespace lamina {
namespace {

using testing::all_vtu_styles;
using testing::expect_equal;
using testing::expected_mesh;
using testing::make_vtu;
using testing::mixed_grid;
using testing::TestArray;
using testing::TestGrid;
using testing::VtkMaker;
using testing::VtuMaker;
using testing::VtuStyle;
using MeshFormats = testing::MeshFiles;

TEST_F(MeshFormats, VtuIsReadInEveryCoding) {
    const MeshData expected = expected_mesh(mixed_grid());
    ASSERT_EQ(expected.tets.size(), 19u);
    for (std::size_t i = 0; i < 24; ++i) {  // lengths of the vectors (2 i, -i, 2 i)
        ASSERT_EQ(expected.point_scalars[1].values[i], 3.0 * static_cast<double>(i));
    }
    for (const VtuStyle& style : all_vtu_styles()) {
        SCOPED_TRACE(style.name());
        const MeshData mesh = read("a.vtu", make_vtu(mixed_grid(), style));
        expect_equal(mesh, expected);
        EXPECT_EQ(mesh.cells.split, 4);
        EXPECT_EQ(mesh.cells.skipped, 2);
    }
}

TEST_F(MeshFormats, LegacyVtkIsReadInEveryVersionAndCoding) {
    TestGrid grid = mixed_grid();
    const MeshData expected = expected_mesh(grid);
    for (const bool binary : {false, true}) {
        for (const bool version5 : {false, true}) {
            SCOPED_TRACE(binary ? "binary" : "ascii");
            const MeshData mesh = read("a.vtk", VtkMaker(binary, version5).file(grid));
            expect_equal(mesh, expected);
            EXPECT_EQ(mesh.cells.split, 4);
            EXPECT_EQ(mesh.cells.skipped, 2);
        }
    }
}

TEST_F(MeshFormats, EveryIntegerTypeIsRead) {
    for (const char* const index :
         {"Int8", "UInt8", "Int16", "UInt16", "Int32", "UInt32", "Int64", "UInt64"}) {
        TestGrid grid = mixed_grid();
        grid.index_type = grid.types_type = index;
        grid.point_arrays[3].type = index;
        for (double& value : grid.point_arrays[3].values) value = std::abs(value);
        const MeshData expected = expected_mesh(grid);
        for (const char* const format : {"ascii", "binary", "raw"}) {
            SCOPED_TRACE(std::string(index) + format);
            expect_equal(read("a.vtu", make_vtu(grid, {format})), expected);
        }
        for (const bool binary : {false, true}) {
            expect_equal(read("a.vtk", VtkMaker(binary, true).file(grid)), expected);
        }
    }
}

// The text of a Float32 array is rounded to float32 like binary values: 0.1f, not 0.1.
TEST_F(MeshFormats, TextOfFloatsIsRoundedToFloats) {
    TestGrid grid = mixed_grid();
    grid.points_type = "Float32";
    const MeshData text = read("a.vtu", make_vtu(grid));
    const MeshData binary = read("a.vtu", make_vtu(grid, {"raw"}));
    expect_equal(text, binary);
    EXPECT_EQ(text.points[0].z, static_cast<double>(0.1f));
    expect_equal(read("a.vtk", VtkMaker(false, true).file(grid)), binary);
}

TEST_F(MeshFormats, PiecesAreJoined) {
    const TestGrid one = mixed_grid();
    TestGrid two = mixed_grid();
    for (auto& point : two.points) point.x += 10;
    std::swap(two.point_arrays[0], two.point_arrays[3]);  // arrays are matched by name
    const MeshData first = expected_mesh(one), second = expected_mesh(two);
    for (const VtuStyle& style : all_vtu_styles()) {
        SCOPED_TRACE(style.name());
        const MeshData mesh = read("a.vtu", VtuMaker(style).file({TestGrid(), one, two}));
        ASSERT_EQ(mesh.tets.size(), 38u);
        ASSERT_EQ(mesh.points.size(), 48u);
        for (std::size_t i = 0; i < 24; ++i) {
            EXPECT_EQ(mesh.points[i], first.points[i]);
            EXPECT_EQ(mesh.points[24 + i], second.points[i]);
            EXPECT_EQ(mesh.point_scalars[0].values[24 + i], second.point_scalars[5].values[i]);
        }
        for (std::size_t i = 0; i < 19; ++i) {
            for (std::size_t corner = 0; corner < 4; ++corner) {
                EXPECT_EQ(mesh.tets[19 + i][corner], second.tets[i][corner] + 24);
            }
            EXPECT_EQ(mesh.cell_scalars[0].values[19 + i], second.cell_scalars[0].values[i]);
        }
    }
}

TEST_F(MeshFormats, UnusualXmlAndUnnamedArraysAreAccepted) {
    const MeshData expected = expected_mesh(mixed_grid());
    // CDATA, comments and information keys stand among the numbers, and a declaration and a comment
    // before the root element.
    std::string text = make_vtu(mixed_grid());
    const auto replace = [&](const std::string& from, const std::string& to) {
        ASSERT_NE(text.find(from), std::string::npos) << from;
        text.replace(text.find(from), from.size(), to);
    };
    text = "<?xml version=\"1.0\"?>\n<!-- made by hand -->\n" + text;
    replace("10 5 12 13", "<!-- types --><InformationKey name=\"X\"/>10 5<![CDATA[ 12 13]]>");
    expect_equal(read("a.vtu", text), expected);

    // Arrays of strings and of bits become no scalars.
    replace("<PointData>",
            "<PointData><Array type=\"String\" Name=\"s\">97 0</Array>"
            "<DataArray type=\"Bit\" Name=\"b\">1</DataArray>");
    expect_equal(read("a.vtu", text), expected);

    // An array without a name is named by its number.
    replace("Name=\"pressure\"", "");
    EXPECT_EQ(read("a.vtu", text).point_scalars[0].name, "array 2");
}

TEST_F(MeshFormats, NaNIsKept) {
    TestGrid grid = mixed_grid();
    grid.point_arrays[0].values[3] = std::nan("");
    grid.point_arrays[1].values[0] = std::nan("");
    for (const char* const format : {"ascii", "binary", "raw"}) {
        const MeshData mesh = read("a.vtu", make_vtu(grid, {format}));
        EXPECT_TRUE(std::isnan(mesh.point_scalars[0].values[3]));
        EXPECT_TRUE(std::isnan(mesh.point_scalars[1].values[0]));
        EXPECT_EQ(mesh.point_scalars[1].values[1], 3);
    }
    EXPECT_TRUE(
        std::isnan(read("a.vtk", VtkMaker(false, false).file(grid)).point_scalars[0].values[3]));
}

constexpr const char* text_points =
    "# vtk DataFile Version 2.0\nsome tet\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 double\n";
constexpr const char* text_cells = "CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\n";

TEST_F(MeshFormats, NumbersAreReadInEverySpelling) {
    const std::string text =
        std::string(text_points) +
        "+1.5 -.5 5.\n1e-3 1E+2 0\t1e-400 -1e-400 4.9e-324 \r\n 1e308 -0 inf\n" + text_cells;
    const MeshData mesh = read("a.vtk", text);
    EXPECT_EQ(mesh.points[0], glm::dvec3(1.5, -0.5, 5));
    EXPECT_EQ(mesh.points[1], glm::dvec3(1e-3, 100, 0));
    EXPECT_EQ(mesh.points[2],
              glm::dvec3(0, 0, 4.9e-324));  // numbers too small for a double become 0
    EXPECT_TRUE(std::signbit(mesh.points[2].y));
    EXPECT_EQ(mesh.points[3].x, 1e308);
    EXPECT_TRUE(std::isinf(mesh.points[3].z));  // TetMesh rejects it if a tet uses it
}

// Reads or skips every other kind of attribute that a legacy file may have.
TEST_F(MeshFormats, LegacyAttributesOfEveryKindAreReadOrSkipped) {
    const std::string text = std::string(text_points) + "0 0 0 1 0 0 0 1 0 0 0 1\n" + text_cells +
                             "cell_data 1\nscalars c int\nlookup_table default\n7\n"
                             "POINT_DATA 4\n"
                             "SCALARS s float 1\nLOOKUP_TABLE mine\n1 2 3 4\n"
                             "LOOKUP_TABLE mine 2\n0 0 0 1\n1 1 1 1\n"
                             "COLOR_SCALARS rgb 3\n0 0 0 1 1 1 0 0 0 1 1 1\n"
                             "NORMALS n float\n0 0 1 0 0 2 0 0 3 0 0 4\n"
                             "TENSORS t float\n" +
                             [] {
                                 std::string nines;
                                 for (int i = 0; i < 36; ++i) nines += "9 ";
                                 return nines;
                             }() +
                             "\nTEXTURE_COORDINATES uv 2 float\n0 0 0 1 1 0 1 1\n"
                             "GLOBAL_IDS ids vtkIdType\n10 11 12 13\n"
                             "FIELD more 4\nlabels 1 4 string\none\ntwo%20words\n\nfour\n"
                             "flags 1 4 bit\n1 0 1 0\nNULL_ARRAY\nx%25 1 4 double\n.1 .2 .3 .4\n";
    const MeshData mesh = read("a.vtk", text);
    ASSERT_EQ(mesh.point_scalars.size(), 7u);
    expect_equal(mesh.point_scalars, {{"s", {1, 2, 3, 4}},
                                      {"n", {1, 2, 3, 4}},
                                      {"n.x", {0, 0, 0, 0}},
                                      {"n.y", {0, 0, 0, 0}},
                                      {"n.z", {1, 2, 3, 4}},
                                      {"ids", {10, 11, 12, 13}},
                                      {"x%", {.1, .2, .3, .4}}});
    expect_equal(mesh.cell_scalars, {{"c", {7}}});
}

const std::string nodes_from_0 =
    "# a comment\n\n4 3 1 1 # first line\n0 0 0 0 0.5 1\n"
    "1 1 0 0 1.5 0 # x\n   # nothing\n2 0 1 0 nan 0\n3 0 0 1 3.5 -1";
const std::string nodes_from_1 =
    "4 3 1 0\r\n1 0 0 0 0.5\r\n2 1 0 0 1.5\r\n3 0 1 0 nan\r\n4 0 0 1 3.5\r\n";

TEST_F(MeshFormats, TetGenIsReadCountedFrom0OrFrom1) {
    write("a.node", nodes_from_0);
    write("a.ele", "1 4 0\n0 0 1 2 3\n");
    write("b.node", nodes_from_1);
    write("b.ele", "1 4 2\n1 1 2 3 4 7 8.5 # corners, then attributes\n");
    const MeshData a = read_mesh(folder() / "a.node"), b = read_mesh(folder() / "b.ele");
    EXPECT_EQ(a.points, b.points);
    EXPECT_EQ(a.points[3], glm::dvec3(0, 0, 1));
    EXPECT_EQ(a.tets, (std::vector<Tet>{{0, 1, 2, 3}}));
    EXPECT_EQ(a.tets, b.tets);
    expect_equal(a.point_scalars, {{"point attribute 1", {0.5, 1.5, std::nan(""), 3.5}}});
    expect_equal(a.point_scalars, b.point_scalars);
    EXPECT_TRUE(a.cell_scalars.empty());
    expect_equal(b.cell_scalars, {{"tet attribute 1", {7}}, {"tet attribute 2", {8.5}}});
}

// TetGen ("-o2") lists corners, then the middles of the edges 2-3, 3-0, 0-1, 1-2, 1-3 and 2-0.
TEST_F(MeshFormats, TetGenTetsOfTenNodesAreCutAtTheMiddlesOfTheirEdges) {
    write("a.node",
          "10 3 1 1\n1 0 0 0 0 1\n2 2 0 0 2 1\n3 0 2 0 4 1\n4 0 0 2 6 1\n5 0 1 1 5 0\n"
          "6 0 0 1 3 0\n7 1 0 0 1 0\n8 1 1 0 3 0\n9 1 0 1 4 0\n10 0 1 0 2 0\n");
    write("a.ele", "1 10 1\n1 1 2 3 4 5 6 7 8 9 10 -3\n");
    const MeshData mesh = read_mesh(folder() / "a.node");
    EXPECT_EQ(mesh.tets.size(), 8u);
    EXPECT_EQ(mesh.points.size(), 10u);
    EXPECT_EQ(mesh.cells.straightened, 1);
    EXPECT_EQ(mesh.cells.turned_over, 0);  // eight tets of 1/6 each
    expect_equal(mesh.cell_scalars, {{"tet attribute 1", std::vector<double>(8, -3)}});
    for (std::size_t i = 0; i < 10; ++i) {
        const glm::dvec3& p = mesh.points[i];
        EXPECT_EQ(mesh.point_scalars[0].values[i], p.x + 2 * p.y + 3 * p.z);
    }
}

TEST_F(MeshFormats, TetGenAttributesAreNamedByComments) {
    write("a.node", "# title\n# point attribute 1: flow speed \n# point attribute 2: none\n" +
                        nodes_from_1 + "# point attribute 1: too late\n");
    write("a.ele", "# tet attribute 2: part\n1 4 2\n1 1 2 3 4 5 6\n");
    const MeshData mesh = read_mesh(folder() / "a.node");
    EXPECT_EQ(mesh.point_scalars[0].name, "flow speed");
    EXPECT_EQ(mesh.cell_scalars[0].name, "tet attribute 1");
    EXPECT_EQ(mesh.cell_scalars[1].name, "part");
}

TEST_F(MeshFormats, WrittenFilesAreReadBackUnchanged) {
    MeshData mesh = read("a.vtu", make_vtu(mixed_grid()));
    mesh.points[5] = {1.0 / 3, -1e-300, 1.7976931348623157e308};
    mesh.point_scalars[0].values[2] = std::nan("");
    for (const std::string extension : {".vtu", ".node"}) {
        const auto path = folder() / ("round" + extension);
        AtomicFile file(path);
        AtomicFile tets(folder() / "round.ele");
        if (extension == ".vtu") {
            write_vtu(file, mesh);
        } else {
            write_node(file, mesh);
            write_ele(tets, mesh);
            tets.commit();
        }
        file.commit();
        expect_equal(read_mesh(path), mesh);
    }
}

TEST_F(MeshFormats, LargeMeshesWithoutScalarsAreReadBack) {
    MeshData mesh;  // 3 MB of points: three blocks, the last of them full
    mesh.points.resize(std::size_t{1} << 17);
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
        mesh.points[i] = glm::dvec3(static_cast<double>(i), static_cast<double>(i % 7), 0.5);
    }
    for (std::int32_t i = 0; i < 100000; ++i) mesh.tets.push_back({i, i + 1, i + 2, i + 3});
    AtomicFile file(folder() / "large.vtu");
    write_vtu(file, mesh);
    file.commit();
    expect_equal(read_mesh(folder() / "large.vtu"), mesh);
}

TEST(MeshFile, IsRecognizedByItsExtension) {
    for (const char* const name : {"a.vtu", "b/a.vtk", "a.node", "a.ele"}) {
        EXPECT_TRUE(is_mesh_file(name)) << name;
    }
    for (const char* const name : {"a.nrrd", "vtu", "a.vtu.gz", ""}) {
        EXPECT_FALSE(is_mesh_file(name)) << name;
    }
    expect_error([] { read_mesh("a.stl"); },
                 {"a.stl", "'.stl'", ".vtu, .pvtu, .pvd, .vtk, .node or .ele"});
}

}  // namespace
}  // namespace lamina
