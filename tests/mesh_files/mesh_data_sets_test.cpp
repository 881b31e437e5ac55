// SPDX-License-Identifier: Apache-2.0
// Checks real meshes against their README, in every format.
#include <algorithm>
#include <set>

#include "mesh_files.h"
#include "mesh_files/mesh_assembly.h"

namespace lamina {
namespace {

using testing::data_folder;
using testing::expect_equal;
using testing::make_vtu;
using testing::TestArray;
using testing::TestGrid;
using testing::VtkMaker;
using testing::VtuStyle;

struct DataSet {
    const char* name;
    std::size_t points, tets;
    const char* scalar;
    double lo, hi, half_digit;  // half a unit of the last digit in the README

    friend void PrintTo(const DataSet& set, std::ostream* stream) { *stream << set.name; }
};

class MeshDataSets : public ::testing::TestWithParam<DataSet> {};

// The two formats agree in these digits: the .node files have 9 significant ones (torso 6, as its
// source), the .vtu are Float32. All coordinates, and the values of three sets, are the float to
// which the text rounds. The speed of can was printed from doubles: 63 of 6,724 of its values round
// to the neighbouring float, so that the two differ by half a float's spacing (2^-24) and half a
// unit of the ninth digit (5e-9).
TEST_P(MeshDataSets, AreTheSameInBothFormats) {
    const DataSet& expected = GetParam();
    const auto vtu = data_folder() / (std::string(expected.name) + ".vtu");
    if (!std::filesystem::exists(vtu)) GTEST_SKIP() << vtu << " is not there";
    const MeshData mesh = read_mesh(vtu);
    EXPECT_EQ(mesh.points.size(), expected.points);
    EXPECT_EQ(mesh.tets.size(), expected.tets);
    ASSERT_EQ(mesh.point_scalars.size(), 1u);
    EXPECT_EQ(mesh.point_scalars[0].name, expected.scalar);
    const auto [lo, hi] = std::ranges::minmax(mesh.point_scalars[0].values);
    EXPECT_NEAR(lo, expected.lo, expected.half_digit);
    EXPECT_NEAR(hi, expected.hi, expected.half_digit);
    EXPECT_EQ(mesh.cells.split, 0);
    EXPECT_EQ(mesh.cells.skipped, 0);

    const MeshData text = read_mesh(std::filesystem::path(vtu).replace_extension(".ele"));
    EXPECT_EQ(text.tets, mesh.tets);
    ASSERT_EQ(text.points.size(), mesh.points.size());
    ASSERT_EQ(text.point_scalars.size(), 1u);
    EXPECT_EQ(text.point_scalars[0].name, expected.scalar);
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
        ASSERT_EQ(glm::vec3(text.points[i]), glm::vec3(mesh.points[i])) << i;
        const double a = text.point_scalars[0].values[i], b = mesh.point_scalars[0].values[i];
        ASSERT_NEAR(a, b, (0x1p-24 + 5e-9) * std::abs(a)) << i;
    }
}

INSTANTIATE_TEST_SUITE_P(
    All, MeshDataSets,
    ::testing::Values(DataSet{"bluntfin", 40921, 187318, "density", 0.1926, 4.9775, 5e-5},
                      DataSet{"combustor", 47025, 215040, "density", 0.19781, 0.71042, 5e-6},
                      DataSet{"torso", 8278, 51419, "voltage", -5058.86, 1780.35, 5e-3},
                      DataSet{"can", 6724, 28800, "speed", 2006.42, 5221.33, 5e-3}),
    [](const auto& test) { return std::string(test.param.name); });

class CanFiles : public testing::MeshFiles {
  protected:
    void SetUp() override {
        const auto path = data_folder() / "can.vtu";
        if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
        can_ = read_mesh(path);
    }
    MeshData can_;
};

TEST_F(CanFiles, AreTheSameInEveryCoding) {
    TestGrid grid;
    grid.points = can_.points;
    grid.points_type = "Float32";
    for (const Tet& tet : can_.tets) grid.cells.push_back({10, {tet.begin(), tet.end()}});
    grid.point_arrays = {{"speed", "Float32", 1, can_.point_scalars[0].values}};
    grid.cell_arrays = {{"id", "Int32", 1, {}}};
    MeshData expected = can_;
    expected.cell_scalars = {{"id", {}}};
    for (std::size_t i = 0; i < can_.tets.size(); ++i) {
        grid.cell_arrays[0].values.push_back(static_cast<double>(i));
    }
    expected.cell_scalars[0].values = grid.cell_arrays[0].values;
    for (const VtuStyle& style : {VtuStyle{"ascii"}, VtuStyle{"binary", true},
                                  VtuStyle{"base64", false, true, true}, VtuStyle{"raw", true}}) {
        SCOPED_TRACE(style.name());
        expect_equal(read("a.vtu", make_vtu(grid, style)), expected);
    }
    for (const bool binary : {false, true}) {
        for (const bool version5 : {false, true}) {
            expect_equal(read("a.vtk", VtkMaker(binary, version5).file(grid)), expected);
        }
    }
    AtomicFile vtu(folder() / "b.vtu"), node(folder() / "b.node"), ele(folder() / "b.ele");
    write_vtu(vtu, expected);
    write_node(node, expected);
    write_ele(ele, expected);
    vtu.commit();
    node.commit();
    ele.commit();
    expect_equal(read_mesh(vtu.path()), expected);
    expect_equal(read_mesh(node.path()), expected);
}

// can.vtu was cut from hexahedra by the rule of split_cell(). Groups of six tets are joined to
// hexahedra again, and split_cell() must give the same tets.
TEST_F(CanFiles, HoldHexahedraCutAsSplitCellCutsThem) {
    ASSERT_EQ(can_.tets.size() % 6, 0u);
    for (std::size_t first = 0; first < can_.tets.size(); first += 96) {  // every 16th hexahedron
        std::set<std::int32_t> corners;
        std::set<std::set<std::int32_t>> tets;
        for (std::size_t i = first; i < first + 6; ++i) {
            corners.insert(can_.tets[i].begin(), can_.tets[i].end());
            tets.insert({can_.tets[i].begin(), can_.tets[i].end()});
        }
        ASSERT_EQ(corners.size(), 8u);
        // The file does not say how the hexahedron was numbered, so all numberings of its corners
        // are tried: one must give these tets. All six tets have the least point.
        std::vector<std::int32_t> order(corners.begin(), corners.end());
        for (const auto& tet : tets) ASSERT_TRUE(tet.contains(order[0]));
        bool found = false;
        do {
            const SplitCell split = split_cell(12, order, can_.points);
            std::set<std::set<std::int32_t>> ours;
            for (const Tet& tet : split.tets) ours.insert({tet.begin(), tet.end()});
            found = ours == tets;
        } while (!found && std::next_permutation(order.begin() + 1, order.end()));
        ASSERT_TRUE(found) << first;
    }
}

}  // namespace
}  // namespace lamina
