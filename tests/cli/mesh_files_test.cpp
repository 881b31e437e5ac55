// SPDX-License-Identifier: Apache-2.0
// Meshes on the command line: lamina info, and lamina render --method trace.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "cli/lamina_run.h"
#include "support/temporary_folder.h"

namespace lamina {
namespace {

using nlohmann::json;

std::string read(const std::string& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

class MeshFiles : public testing::Test {
  protected:
    // Writes the unit cube with the scalar x + 2y + 4z, as six tets around a diagonal.
    MeshFiles() {
        std::string nodes = "8 3 1 0\n";
        for (int i = 0; i < 8; ++i)
            nodes += fmt("%d %d %d %d %d\n", i, i & 1, i >> 1 & 1, i >> 2, i);
        write("cube.node", nodes);
        write("cube.ele",
              "6 4 0\n0 0 1 3 7\n1 0 2 6 7\n2 0 4 5 7\n3 0 3 2 7\n4 0 6 4 7\n5 0 5 1 7\n");
    }

    template <typename... Numbers>
    static std::string fmt(const char* format, Numbers... numbers) {
        char text[64];
        std::snprintf(text, sizeof text, format, numbers...);
        return text;
    }
    std::string path(const std::string& name) const { return folder_ / name; }
    void write(const std::string& name, const std::string& text) const {
        std::ofstream(path(name)) << text;
    }
    // Writes a scene that looks along -z at a part of the cube; extinction is 2 everywhere.
    void write_scene(const std::string& name, const json& mesh, const json& volume = {}) const {
        json scene = {{"version", 1},
                      {"mesh", mesh},
                      {"transfer_function", {{"points", {{{"value", 0}, {"extinction", 2}}}}}},
                      {"camera",
                       {{"projection", "orthographic"},
                        {"eye", {.5, .5, 5}},
                        {"center", {.5, .5, .5}},
                        {"height", .5}}},
                      {"image", {{"width", 4}, {"height", 4}}},
                      {"render", {{"method", "trace"}, {"trace", {{"of", "mesh"}}}}}};
        if (!volume.is_null()) scene["volume"] = volume;
        write(name, scene.dump());
    }

  private:
    TemporaryFolder folder_;
};

TEST_F(MeshFiles, InfoDescribesAMesh) {
    const ProgramResult result =
        lamina_run({"info", path("cube.ele"), "--json", "--png", path("cube.png")});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const json info = json::parse(result.out);
    EXPECT_EQ(info["kind"], "mesh");
    EXPECT_EQ(info["points"], 8);
    EXPECT_EQ(info["tets"], 6);
    EXPECT_EQ(info["bounds"]["max"], (json{1.0, 1.0, 1.0}));
    EXPECT_EQ(info["scalars"][0]["range"], (json{0.0, 7.0}));
    EXPECT_EQ(info["boundary_faces"], 12);
    EXPECT_EQ(info["conforming"], true);
    EXPECT_EQ(info["convex"], true);
    EXPECT_NEAR(info["edge_ratio"].get<double>(), std::sqrt(3.0), 1e-15);
    for (const char* key : {"degenerate", "inverted", "duplicates", "nonmanifold_faces",
                            "folded_faces", "unused_points"}) {
        EXPECT_EQ(info[key], 0) << key;
    }
    EXPECT_TRUE(std::filesystem::exists(path("cube.png")));
}

// A .npy file has a header of 128 bytes and then doubles. The cube is 1 long along z, so alpha is
// 1 - exp(-2), up to the rounding of a few sums.
TEST_F(MeshFiles, AreTracedInDoublePrecision) {
    write_scene("s.json", "cube.node");
    const ProgramResult result =
        lamina_run({"render", path("s.json"), "-o", path("s.npy"), "--stats", path("stats.json")});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const std::string npy = read(path("s.npy"));
    ASSERT_EQ(npy.size(), 128 + 4 * 4 * 4 * sizeof(double));
    for (std::size_t pixel = 0; pixel < 16; ++pixel) {
        double alpha = 0;
        std::memcpy(&alpha, npy.data() + 128 + (4 * pixel + 3) * sizeof alpha, sizeof alpha);
        EXPECT_NEAR(alpha, -std::expm1(-2.0), 4e-16);
    }
    const json stats = json::parse(read(path("stats.json")));
    EXPECT_EQ(stats["counts"]["tets"], 6);
    EXPECT_EQ(stats["counts"]["overlapping_rays"], 0);
    EXPECT_LT(stats["error_estimate"].get<double>(), 1e-12);
}

TEST_F(MeshFiles, DrawTheSameAsMeshesOfScenes) {
    ASSERT_EQ(
        lamina_run({"generate", "gaussians", "--size", "9,8,7", "-o", path("g.nrrd")}).exit_code,
        0);
    const ProgramResult made = lamina_run({"mesh", path("g.nrrd"), "-o", path("g.vtu"), "--kuhn"});
    ASSERT_EQ(made.exit_code, 0) << made.err;
    write_scene("v.json", {{"kuhn", true}}, "g.nrrd");
    write_scene("m.json", "g.vtu");
    for (const std::string name : {"v", "m"}) {
        const ProgramResult result =
            lamina_run({"render", path(name + ".json"), "-o", path(name + ".npy")});
        ASSERT_EQ(result.exit_code, 0) << result.err;
    }
    EXPECT_EQ(read(path("v.npy")), read(path("m.npy")));
}

TEST_F(MeshFiles, MayHaveNamesThatAreNotUtf8) {
    const std::string name =
        "Dr\xfc"
        "ck";  // Latin-1
    write("latin.node", "# point attribute 1: " + name + "\n" + read(path("cube.node")));
    write("latin.ele", read(path("cube.ele")));
    const ProgramResult info = lamina_run({"info", path("latin.node"), "--json"});
    ASSERT_EQ(info.exit_code, 0) << info.err;
    EXPECT_EQ(json::parse(info.out)["scalars"][0]["name"], "Dr\uFFFDck");
    EXPECT_EQ(lamina_run({"info", path("latin.node")}).exit_code, 0);
    write_scene("latin.json", "latin.node");
    const ProgramResult drawn = lamina_run(
        {"render", path("latin.json"), "--set", "scalar=" + name, "-o", path("latin.exr")});
    EXPECT_EQ(drawn.exit_code, 0) << drawn.err;
}

TEST_F(MeshFiles, AreReportedInOneLineIfBadAndLeaveNothing) {
    write("cube.ele", "1 4 0\n0 0 1 3 8\n");
    write_scene("s.json", "cube.node");
    const ProgramResult result = lamina_run({"render", path("s.json"), "-o", path("s.exr")});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_NE(result.err.find("cube.ele"), std::string::npos) << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1);
    EXPECT_FALSE(std::filesystem::exists(path("s.exr")));
    EXPECT_EQ(lamina_run({"info", path("none.vtu")}).exit_code, 1);
    EXPECT_EQ(lamina_run({"info", path("s.json")}).exit_code, 1);
}

// The six tets of the cube have points of their own, of which those of the last tet lie 1e-9 to the
// right and have values that are 1 larger. The faces inside the cube are six, two at each tet.
TEST_F(MeshFiles, PointsAtOnePlaceAreCountedAndJoined) {
    const std::vector<std::vector<int>> tets{{0, 1, 3, 7}, {0, 2, 6, 7}, {0, 4, 5, 7},
                                             {0, 3, 2, 7}, {0, 6, 4, 7}, {0, 5, 1, 7}};
    std::string nodes = "24 3 1 0\n", elements = "6 4 0\n";
    for (int tet = 0; tet < 6; ++tet) {
        for (int k = 0; k < 4; ++k) {
            const int i = tets[static_cast<std::size_t>(tet)][static_cast<std::size_t>(k)];
            nodes += fmt("%d %.10g %d %d %d\n", 4 * tet + k, (i & 1) + (tet == 5 ? 1e-9 : 0.0),
                         i >> 1 & 1, i >> 2, i + (tet == 5));
        }
        elements += fmt("%d %d %d %d %d\n", tet, 4 * tet, 4 * tet + 1, 4 * tet + 2, 4 * tet + 3);
    }
    write("split.node", nodes);
    write("split.ele", elements);
    const json info = json::parse(lamina_run({"info", path("split.node"), "--json"}).out);
    EXPECT_EQ(info["points"], 24);
    EXPECT_EQ(info["places"], 8 + 4);
    EXPECT_EQ(info["scalars"][0]["jumps"], 0);
    EXPECT_EQ(info["boundary_faces"], 12 + 4);

    write_scene("split.json", {{"path", "split.node"}, {"join", 1e-8}});
    const ProgramResult result = lamina_run(
        {"render", path("split.json"), "-o", path("split.exr"), "--stats", path("stats.json")});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.err.find("4 points took the place of an earlier one, up to 1e-09 away"),
              std::string::npos)
        << result.err;
    EXPECT_NE(result.err.find("24 points lie at 8 places"), std::string::npos) << result.err;
    const json counts = json::parse(read(path("stats.json")))["counts"];
    EXPECT_EQ(counts["copied_points"], 24 - 8);
    EXPECT_EQ(counts["overlapping_rays"], 0);

    for (std::size_t at = 0; (at = nodes.find("e-09", at)) != std::string::npos;)
        nodes.replace(at - 1, 5, "0");
    for (std::size_t at = 0; (at = nodes.find("1.000000001", at)) != std::string::npos;)
        nodes.replace(at, 11, "1");
    write("split.node", nodes);
    const json joined = json::parse(lamina_run({"info", path("split.node"), "--json"}).out);
    EXPECT_EQ(joined["places"], 8);
    EXPECT_EQ(joined["scalars"][0]["jumps"], 2);
    EXPECT_EQ(joined["boundary_faces"], 12);
}

TEST_F(MeshFiles, DrawTheOnlyArrayOfCellsAndAskForOneOfSeveral) {
    write("c.node", "4 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n");
    write("c.ele", "1 4 1\n1 1 2 3 4 .5\n");
    write_scene("c.json", "c.node");
    const ProgramResult one = lamina_run({"render", path("c.json"), "-o", path("c.exr")});
    ASSERT_EQ(one.exit_code, 0) << one.err;
    EXPECT_NE(one.err.find("\"tet attribute 1\" is cell data: averaged to points"),
              std::string::npos)
        << one.err;
    const json info = json::parse(lamina_run({"info", path("c.ele"), "--json"}).out);
    EXPECT_EQ(info["drawn_scalar"], "tet attribute 1");
    EXPECT_EQ(info["percentiles"]["50"], .5);
    EXPECT_TRUE(info["scalars"].empty());

    write("c.ele", "1 4 2\n1 1 2 3 4 .5 2\n");
    const ProgramResult two = lamina_run({"render", path("c.json"), "-o", path("d.exr")});
    EXPECT_EQ(two.exit_code, 1);
    for (const char* const part : {"--set scalar=NAME", "tet attribute 1", "tet attribute 2"})
        EXPECT_NE(two.err.find(part), std::string::npos) << two.err;
    EXPECT_EQ(lamina_run({"render", path("c.json"), "--set", "scalar=tet attribute 2", "-o",
                          path("d.exr")})
                  .exit_code,
              0);
    EXPECT_TRUE(
        json::parse(lamina_run({"info", path("c.ele"), "--json"}).out)["drawn_scalar"].is_null());
}

// The diagonals of cut hexahedra show where the field peaks: it is said once.
TEST_F(MeshFiles, SayOnceThatHexahedraBecomeTets) {
    write("h.vtk",
          "# vtk DataFile Version 3.0\n\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 8 float\n"
          "0 0 0 1 0 0 1 1 0 0 1 0 0 0 1 1 0 1 1 1 1 0 1 1\nCELLS 1 9\n8 0 1 2 3 4 5 6 7\n"
          "CELL_TYPES 1\n12\nPOINT_DATA 8\nSCALARS s float\nLOOKUP_TABLE t\n0 0 0 0 0 0 0 1\n");
    write_scene("h.json", "h.vtk");
    const ProgramResult result = lamina_run({"render", path("h.json"), "-o", path("h.exr")});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const std::size_t first = result.err.find("hexahedra or other cells are cut into tets");
    EXPECT_NE(first, std::string::npos) << result.err;
    EXPECT_EQ(result.err.find("cut into tets", first + 40), std::string::npos) << result.err;
}

// TetGen lists the middles of the edges 2-3, 3-0, 0-1, 1-2, 1-3 and 2-0.
TEST_F(MeshFiles, QuadraticCellsAreCutAtTheirPointsAndCounted) {
    std::string nodes = "10 3 1 0\n1 0 0 0 0\n2 1 0 0 0\n3 0 1 0 0\n4 0 0 1 0\n";
    nodes += "5 0 .5 .5 .5\n6 0 0 .5 .5\n7 .5 0 0 .5\n8 .5 .5 0 .5\n9 .5 0 .5 .5\n10 0 .5 0 .5\n";
    write("q.node", nodes);
    write("q.ele", "1 10 0\n1 1 2 3 4 5 6 7 8 9 10\n");
    write_scene("q.json", "q.node");
    const ProgramResult result =
        lamina_run({"render", path("q.json"), "-o", path("q.exr"), "--stats", path("stats.json")});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.err.find("1 quadratic or higher cells are drawn as straight pieces"),
              std::string::npos);
    const json counts = json::parse(read(path("stats.json")))["counts"];
    EXPECT_EQ(counts["straightened_cells"], 1);
    EXPECT_EQ(counts["turned_over_tets"], 0);
    EXPECT_EQ(counts["tets"], 8);
}

}  // namespace
}  // namespace lamina
