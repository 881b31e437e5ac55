// SPDX-License-Identifier: Apache-2.0
// Cells of higher order and polyhedra are cut into tets that fill them, keep linear fields, conform
// with neighbours, and have values at the points that VTK's shape functions say.
#include <sys/wait.h>

#include <glm/geometric.hpp>

#include <algorithm>

#include "mesh/tet_mesh.h"
#include "mesh_files.h"
#include "mesh_files/text_reader.h"

namespace lamina {
namespace {

using CurvedCells = testing::MeshFiles;
using testing::make_vtu;
using testing::TestGrid;

struct Expected {
    double volume = 0;
    std::int64_t boundary = 0, turned = 0;
    std::vector<std::array<double, 4>> made;  // x, y, z, value
};

Expected read_expected(const std::filesystem::path& path) {
    const std::string text = read_bytes_of(path);
    TextReader reader(text);
    Expected expected;
    while (!reader.at_end()) {
        const std::string_view word = reader.word();
        bool good = word == "made";
        if (word == "volume") good = reader.read(expected.volume);
        if (word == "boundary") good = reader.read(expected.boundary);
        if (word == "turned") good = reader.read(expected.turned);
        if (word == "made") {
            for (double& number : expected.made.emplace_back()) good &= reader.read(number);
        }
        EXPECT_TRUE(good) << word;
    }
    return expected;
}

double volume_of(const MeshData& mesh, const Tet& tet) {
    const auto p = [&](std::size_t i) { return mesh.points[static_cast<std::size_t>(tet[i])]; };
    return glm::dot(glm::cross(p(1) - p(0), p(2) - p(0)), p(3) - p(0)) / 6;
}

const std::vector<double>& values_of(const MeshData& mesh, const std::string& name) {
    return std::ranges::find(mesh.point_scalars, name, &MeshScalar::name)->values;
}

void expect_as(const Expected& expected, MeshData mesh) {
    double sum = 0;
    for (const Tet& tet : mesh.tets) {
        sum += volume_of(mesh, tet);
        // Bent cells may have flat tets, straight ones may have those of hanging points.
        EXPECT_GT(volume_of(mesh, tet), expected.volume > 0 ? -1e-12 : -1);
    }
    // Volumes up to 64 are sums of up to 6000 products, each rounded by some 1e-16 of itself.
    if (expected.volume > 0) {
        EXPECT_NEAR(sum, expected.volume, 1e-12 * expected.volume);
    }
    EXPECT_EQ(mesh.cells.turned_over, expected.turned);
    EXPECT_EQ(mesh.cells.not_star_shaped, 0);
    const std::vector<double>&linear = values_of(mesh, "linear"), &values = values_of(mesh, "s");
    const auto given = mesh.points.size() - static_cast<std::size_t>(mesh.cells.made_points);
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
        const glm::dvec3& p = mesh.points[i];
        // Weights up to 1/2 of 20 points with values up to 20.
        ASSERT_NEAR(linear[i], 1 + p.x + 2 * p.y - 3 * p.z, 1e-13);
    }
    for (std::size_t i = 0; i < expected.made.size(); ++i) {
        ASSERT_LT(given + i, mesh.points.size());
        const auto& [x, y, z, value] = expected.made[i];
        EXPECT_LT(glm::distance(mesh.points[given + i], glm::dvec3(x, y, z)), 1e-14);
        EXPECT_NEAR(values[given + i], value, 1e-14);
    }
    const TetMesh checked(std::move(mesh), "mesh");
    EXPECT_TRUE(checked.findings().conforming());
    EXPECT_EQ(checked.findings().folded_faces, 0);
    EXPECT_EQ(checked.findings().duplicates, 0);
    EXPECT_EQ(checked.findings().boundary_faces, expected.boundary);
    EXPECT_EQ(checked.findings().unused_points, 0);
}

TEST_F(CurvedCells, AreCutAsVtkSaysInEveryFormat) {
    const int status = run_script("curved_cells.py");
    if (WEXITSTATUS(status) == 77) GTEST_SKIP() << "python3-vtk9 is not installed";
    ASSERT_EQ(status, 0);
    int files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder())) {
        if (entry.path().extension() != ".expected") continue;
        const std::string name = entry.path().stem().string();
        SCOPED_TRACE(name);
        const MeshData mesh = read_mesh(folder() / name);
        EXPECT_EQ(name.starts_with("bent") || name.starts_with("straight"),
                  mesh.cells.straightened == 1 && !name.starts_with("lagrange") &&
                      !name.starts_with("orders"));
        expect_as(read_expected(entry.path()), mesh);
        EXPECT_EQ(TetMesh(MeshData(mesh), name).has_copies(), name.starts_with("apart"));
        ++files;
    }
    // 9 quadratic types straight and bent, 7 meshes of polyhedra and 2 of neighbours, 7 of these
    // with cells that share no points, and tets and wedges of 10 orders, thrice, but two legacy
    // files less of cells with Lagrange hexahedra; 10 orders of these twice; 4 files with orders
    // along axes.
    EXPECT_GE(files, 3 * (16 + 7 + 2 + 7 + 20) - 2 + 2 * 10 + 4);
}

// A tet of the second order whose long edge's middle lies beyond the opposite edge.
TestGrid curved_tet(double bulge) {
    TestGrid grid;
    grid.points = {{0, 0, 0},   {1, 0, 0},  {0, 1, 0},  {0, 0, 1},   {.5, bulge, bulge},
                   {.5, .5, 0}, {0, .5, 0}, {0, 0, .5}, {.5, 0, .5}, {0, .5, .5}};
    grid.cells = {{24, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}}};
    grid.point_arrays = {{"s", "Float64", 1, {0, 0, 0, 0, 1, 2, 3, 4, 5, 6}}};
    return grid;
}

TEST_F(CurvedCells, CountTheTetsThatCurvedEdgesTurnOver) {
    const MeshData straight = read("a.vtu", make_vtu(curved_tet(0)));
    EXPECT_EQ(straight.tets.size(), 8u);
    EXPECT_EQ(straight.cells.straightened, 1);
    EXPECT_EQ(straight.cells.split, 0);
    EXPECT_EQ(straight.cells.turned_over, 0);
    // The middle of edge 0-1 goes through the plane of the middles 5, 6, 7, 8 (y + z = .5).
    const MeshData bent = read("b.vtu", make_vtu(curved_tet(.75)));
    std::int64_t negative = 0;
    for (const Tet& tet : bent.tets) negative += volume_of(bent, tet) < 0;
    EXPECT_GT(negative, 0);
    EXPECT_EQ(bent.cells.turned_over, negative);
    const TetMesh mesh(MeshData(bent), "bent");
    EXPECT_EQ(mesh.findings().inverted, negative);
}

// The octahedron in the middle is cut around its shortest diagonal, here that of points 4 and 9.
TEST_F(CurvedCells, QuadraticTetsAreCutAroundTheirShortestDiagonal) {
    TestGrid grid = curved_tet(.1);
    const MeshData mesh = read("a.vtu", make_vtu(grid));
    EXPECT_EQ(std::ranges::count_if(mesh.tets,
                                    [](const Tet& tet) {
                                        return std::ranges::count(tet, 4) == 1 &&
                                               std::ranges::count(tet, 9) == 1;
                                    }),
              4);
    EXPECT_EQ(mesh.point_scalars[0].values, grid.point_arrays[0].values);
}

TEST_F(CurvedCells, LagrangeHexahedraOfOldFilesHaveOtherNumbers) {
    // Order 2: only the edges 2 and 3 along z, points 18 and 19, change places.
    TestGrid grid;
    constexpr int steps[27][3] = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {0, 0, 2}, {2, 0, 2},
                                  {2, 2, 2}, {0, 2, 2}, {1, 0, 0}, {2, 1, 0}, {1, 2, 0}, {0, 1, 0},
                                  {1, 0, 2}, {2, 1, 2}, {1, 2, 2}, {0, 1, 2}, {0, 0, 1}, {2, 0, 1},
                                  {2, 2, 1}, {0, 2, 1}, {0, 1, 1}, {2, 1, 1}, {1, 0, 1}, {1, 2, 1},
                                  {1, 1, 0}, {1, 1, 2}, {1, 1, 1}};
    grid.cells = {{72, {}}};
    for (const auto& step : steps) {
        grid.cells[0].corners.push_back(static_cast<int>(grid.points.size()));
        grid.points.emplace_back(step[0], step[1], step[2]);
    }
    const auto turned = [&](const std::string& version) {
        std::string text = make_vtu(grid);
        const std::string old = "version=\"0.1\"";
        text.replace(text.find(old), old.size(), version);
        return read("a.vtu", text).cells.turned_over;
    };
    EXPECT_EQ(turned("version=\"2.1\""), 0);
    EXPECT_EQ(turned("version=\"2.2\""), 0);
    EXPECT_GT(turned("version=\"2.0\""), 0);
    EXPECT_GT(turned(""), 0);
    std::swap(grid.cells[0].corners[18], grid.cells[0].corners[19]);
    EXPECT_EQ(turned("version=\"1.0\""), 0);
    EXPECT_GT(turned("version=\"2.1\""), 0);
    EXPECT_EQ(read("a.vtk", testing::VtkMaker(true, false).file(grid)).cells.turned_over, 0);
    EXPECT_GT(read("a.vtk", testing::VtkMaker(true, true).file(grid)).cells.turned_over, 0);
}

TEST_F(CurvedCells, LagrangeCellsOfNoOrderAreRefused) {
    TestGrid grid;
    for (int i = 0; i < 30; ++i) grid.points.emplace_back(i, i * i, i * i * i);
    for (const auto& [type, count] : {std::pair{71, 11}, {72, 12}, {73, 14}, {74, 30}}) {
        grid.cells = {{type, {}}};
        for (int i = 0; i < count; ++i) grid.cells[0].corners.push_back(i);
        expect_error([&] { read("a.vtu", make_vtu(grid)); },
                     {"a.vtu", "cell 0", "a Lagrange", fmt::format("found {} points", count),
                      type == 74 ? "from 1 to 2" : "from 1 to 10"});
    }
}

TEST_F(CurvedCells, OrdersAlongAxesMustFitTheShape) {
    TestGrid grid;
    for (int i = 0; i < 24; ++i) grid.points.emplace_back(i, i * i, i * i * i);
    const auto expect_refused = [&](int type, int count, const std::string& orders) {
        grid.cells = {{type, {}}};
        for (int i = 0; i < count; ++i) grid.cells[0].corners.push_back(i);
        std::string text = make_vtu(grid);
        const std::string data = "<CellData>";
        text.replace(text.find(data), data.size(),
                     "<CellData HigherOrderDegrees=\"o\"><DataArray type=\"Float64\" Name=\"o\" "
                     "NumberOfComponents=\"3\" format=\"ascii\">" +
                         orders + "</DataArray>");
        expect_error([&] { read("a.vtu", text); }, {"cell 0", "HigherOrderDegrees"});
    };
    expect_refused(72, 24, "2 1 2");  // 18 points
    expect_refused(72, 8, "0 1 3");   // below 1
    expect_refused(72, 8, "nan 1 1");
    expect_refused(72, 8, "3 1 1e9");
    expect_refused(73, 20, "3 2 1");  // the triangles' edges have one order
    expect_refused(71, 10, "2 2 1");
}

// Order 1 is straight; a pyramid of order 2 lacks the middle of its base, or has it.
TEST_F(CurvedCells, LagrangePyramidsHaveFiveThirteenOrFourteenPoints) {
    TestGrid grid;
    grid.points = {{0, 0, 0},    {2, 0, 0},     {2, 2, 0},    {0, 2, 0}, {1, 1, 2},
                   {1, 0, 0},    {2, 1, 0},     {1, 2, 0},    {0, 1, 0}, {.5, .5, 1},
                   {1.5, .5, 1}, {1.5, 1.5, 1}, {.5, 1.5, 1}, {1, 1, 0}};
    for (const std::size_t count : {5u, 13u, 14u}) {
        grid.cells = {{74, {}}};
        for (std::size_t i = 0; i < count; ++i)
            grid.cells[0].corners.push_back(static_cast<int>(i));
        const MeshData mesh = read("a.vtu", make_vtu(grid));
        EXPECT_EQ(mesh.tets.size(), count == 5 ? 2u : 16u);
        EXPECT_EQ(mesh.cells.straightened, count == 5 ? 0 : 1);
        EXPECT_EQ(mesh.cells.made_points, count == 13 ? 1 : 0);
        double sum = 0;
        for (const Tet& tet : mesh.tets) sum += volume_of(mesh, tet);
        EXPECT_NEAR(sum, 8. / 3, 1e-14);
        EXPECT_EQ(mesh.points.back(), glm::dvec3(1, 1, 0));
    }
}

// Points that pieces share also share what is made between them.
TEST_F(CurvedCells, PiecesShareTheMiddlesOfTheirFaces) {
    constexpr int steps[20][3] = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {0, 0, 2},
                                  {2, 0, 2}, {2, 2, 2}, {0, 2, 2}, {1, 0, 0}, {2, 1, 0},
                                  {1, 2, 0}, {0, 1, 0}, {1, 0, 2}, {2, 1, 2}, {1, 2, 2},
                                  {0, 1, 2}, {0, 0, 1}, {2, 0, 1}, {2, 2, 1}, {0, 2, 1}};
    std::vector<TestGrid> pieces(2);
    for (int piece = 0; piece < 2; ++piece) {
        TestGrid& grid = pieces[static_cast<std::size_t>(piece)];
        grid.cells = {{25, {}}};
        grid.point_arrays = {{"s", "Float64", 1, {}}};
        grid.cell_arrays = {{"c", "Float64", 1, {10. + piece}}};
        for (const auto& step : steps) {
            grid.cells[0].corners.push_back(static_cast<int>(grid.points.size()));
            grid.points.emplace_back(step[0] + 2 * piece, step[1], step[2]);
            grid.point_arrays[0].values.push_back(3 * (step[0] + 2 * piece) + step[1] - step[2]);
        }
    }
    const MeshData mesh = read("a.vtu", testing::VtuMaker({"raw"}).file(pieces));
    EXPECT_EQ(mesh.cells.merged_points, 8);
    EXPECT_EQ(mesh.cells.made_points, 7 + 6);
    ASSERT_EQ(mesh.point_scalars[0].values.size(), mesh.points.size());
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
        const glm::dvec3& p = mesh.points[i];
        EXPECT_NEAR(mesh.point_scalars[0].values[i], 3 * p.x + p.y - p.z, 1e-14);
    }
    ASSERT_EQ(mesh.tets.size(), 96u);
    for (std::size_t i = 0; i < 96; ++i)
        EXPECT_EQ(mesh.cell_scalars[0].values[i], i < 48 ? 10 : 11);
    const TetMesh checked(MeshData(mesh), "mesh");
    EXPECT_EQ(checked.findings().boundary_faces, 10 * 8);
    EXPECT_TRUE(checked.findings().conforming());
}

}  // namespace
}  // namespace lamina
