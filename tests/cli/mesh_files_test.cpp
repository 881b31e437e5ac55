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

// Mid-edge points of a quadratic tet are not drawn; the program warns and counts them.
TEST_F(MeshFiles, QuadraticCellsAreCountedAndDrawnStraight) {
    std::string nodes = "10 3 1 0\n1 0 0 0 0\n2 1 0 0 0\n3 0 1 0 0\n4 0 0 1 0\n";
    for (int i = 5; i <= 10; ++i) nodes += fmt("%d %g .5 .5 0\n", i, i / 20.0);
    write("q.node", nodes);
    write("q.ele", "1 10 0\n1 1 2 3 4 5 6 7 8 9 10\n");
    write_scene("q.json", "q.node");
    const ProgramResult result =
        lamina_run({"render", path("q.json"), "-o", path("q.exr"), "--stats", path("stats.json")});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.err.find("1 quadratic cells are drawn with straight edges"),
              std::string::npos);
    EXPECT_EQ(json::parse(read(path("stats.json")))["counts"]["straightened_cells"], 1);
}

}  // namespace
}  // namespace lamina
