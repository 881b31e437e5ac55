// SPDX-License-Identifier: Apache-2.0
// lamina mesh.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/lamina_run.h"
#include "support/temporary_folder.h"

namespace lamina {
namespace {

using nlohmann::json;

bool with_tetgen() {
    return !std::string(LAMINA_TETRAHEDRALIZE_BINARY).empty();
}

// Makes a volume of 12^3 samples, and a scene that shows nothing of it.
class MeshVerb : public testing::Test {
  protected:
    void SetUp() override {
        ASSERT_EQ(
            lamina_run({"generate", "gaussians", "-o", volume, "--size", "12,12,12"}).exit_code, 0);
        write_bytes_to(
            scene, json{{"version", 1},
                        {"volume", "v.nrrd"},
                        {"mesh", {{"tolerance", 0.05}, {"kuhn", false}}},
                        {"transfer_function",
                         {{"points", {{{"value", 0}, {"color", {1, 1, 1}}, {"extinction", 0}}}}}},
                        {"camera",
                         {{"projection", "orthographic"},
                          {"height", 1},
                          {"eye", {0, 0, 5}},
                          {"center", {0, 0, 0}},
                          {"up", {0, 1, 0}}}},
                        {"image", {{"width", 4}, {"height", 4}}}}
                       .dump());
    }
    json info(const std::string& mesh) {
        const ProgramResult result = lamina_run({"info", mesh, "--json"});
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return json::parse(result.out);
    }

    TemporaryFolder folder;
    std::string volume = folder / "v.nrrd", scene = folder / "s.json";
    std::string vtu = folder / "m.vtu", node = folder / "m.node";
};

// 0 and 5000000000: codes of labels would be 0 and 1.
TEST_F(MeshVerb, SaysThatItInterpolatesBetweenLabels) {
    std::string values;
    for (const char* const label : {" 0", " 5000000000"})
        for (int i = 0; i < 480; ++i) values += label;
    write_bytes_to(
        volume,
        "NRRD0004\ntype: int64\ndimension: 3\nsizes: 4 4 60\nencoding: ascii\n\n" + values + "\n");
    const ProgramResult result = lamina_run({"mesh", volume, "-o", vtu, "--kuhn"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.err.find("v.nrrd: its samples are labels, and the mesh interpolates"),
              std::string::npos)
        << result.err;
    EXPECT_EQ(result.err.find("numbered"), std::string::npos) << result.err;
    EXPECT_EQ(info(vtu)["scalars"][0]["range"], json({0, 5000000000.}));
}

TEST_F(MeshVerb, KuhnNeedsNoTetGen) {
    const ProgramResult result = lamina_run({"mesh", volume, "-o", vtu, "--kuhn"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.out.find("tets: 7986 "), std::string::npos) << result.out;
    const json mesh = info(vtu);
    EXPECT_EQ(mesh["tets"], 6 * 11 * 11 * 11);
    EXPECT_EQ(mesh["points"], 12 * 12 * 12);
    EXPECT_EQ(mesh["conforming"], true);
    EXPECT_EQ(mesh["inverted"], 0);
    EXPECT_EQ(mesh["scalars"][0]["name"], "scalar");
    // 6 * 11^3 tets are more than 5000: an error, and no file remains.
    std::filesystem::remove(vtu);
    const ProgramResult many =
        lamina_run({"mesh", volume, "-o", vtu, "--kuhn", "--max-tets", "5000"});
    EXPECT_EQ(many.exit_code, 1);
    EXPECT_NE(many.err.find("7986"), std::string::npos) << many.err;
    EXPECT_NE(many.err.find("--max-tets"), std::string::npos) << many.err;
    EXPECT_FALSE(std::filesystem::exists(vtu));
}

TEST_F(MeshVerb, WritesTheSameAdaptiveMeshInBothFormats) {
    if (!with_tetgen()) GTEST_SKIP() << "built without TetGen";
    const ProgramResult result = lamina_run({"mesh", volume, "-o", node, "--tolerance", "0.08"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err, "");
    EXPECT_NE(result.out.find("error: at most 0.0"), std::string::npos) << result.out;
    ASSERT_EQ(lamina_run({"mesh", volume, "-o", vtu, "--tolerance", "0.08"}).exit_code, 0);
    const json a = info(node), b = info(vtu);
    EXPECT_LT(a["tets"], 7986);
    EXPECT_EQ(a["tets"], b["tets"]);
    EXPECT_EQ(a["points"], b["points"]);
    EXPECT_EQ(a["conforming"], true);
    EXPECT_EQ(a["degenerate"], 0);
    EXPECT_EQ(a["bounds"], b["bounds"]);
}

TEST_F(MeshVerb, WarnsIfMaxTetsLimitsTheError) {
    if (!with_tetgen()) GTEST_SKIP() << "built without TetGen";
    const ProgramResult result = lamina_run({"mesh", volume, "-o", vtu, "--max-tets", "300"});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_NE(result.err.find("--max-tets 300"), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("wanted 0.02"), std::string::npos) << result.err;
    EXPECT_LE(info(vtu)["tets"], 300);
}

TEST_F(MeshVerb, UsesTheScenesTransferFunctionAndSettings) {
    if (!with_tetgen()) GTEST_SKIP() << "built without TetGen";
    const ProgramResult result = lamina_run({"mesh", scene, "-o", vtu});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(info(vtu)["points"], 8);
    ASSERT_EQ(lamina_run({"mesh", scene, "-o", vtu, "--kuhn"}).exit_code, 0);
    EXPECT_EQ(info(vtu)["tets"], 7986);
}

TEST_F(MeshVerb, ExitsWith2ForMistakesOfUsage) {
    for (const std::vector<std::string>& wrong : {std::vector<std::string>{"--tolerance", "0"},
                                                  {"--tolerance", "-1"},
                                                  {"--tolerance", "1.5"},
                                                  {"--tolerance", "nan"},
                                                  {"--tolerance", "small"},
                                                  {"--max-tets", "5"},
                                                  {"--max-tets", "1e6"},
                                                  {"--max-tets", "600000000"},
                                                  {"--max-tets", "99999999999999999999"}}) {
        std::vector<std::string> arguments{"mesh", volume, "-o", vtu};
        arguments.insert(arguments.end(), wrong.begin(), wrong.end());
        const ProgramResult result = lamina_run(arguments);
        EXPECT_EQ(result.exit_code, 2) << wrong[1] << result.err;
        EXPECT_NE(result.err.find(wrong[0]), std::string::npos) << result.err;
        EXPECT_FALSE(std::filesystem::exists(vtu));
    }
    EXPECT_EQ(lamina_run({"mesh", volume, "-o", folder / "m.obj"}).exit_code, 2);
    EXPECT_EQ(lamina_run({"mesh", volume}).exit_code, 2);
}

TEST_F(MeshVerb, SaysHowToGetTheMissingProgram) {
    std::filesystem::copy_file(LAMINA_BINARY, folder / "lamina");
    std::filesystem::permissions(folder / "lamina", std::filesystem::perms::owner_all);
    const std::string command = "PATH=/nonexistent '" + (folder / "lamina").string() + "' mesh '" +
                                volume + "' -o '" + vtu + "'";
    const ProgramResult result = run_program({"sh", "-c", command});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_NE(result.err.find("lamina-tetrahedralize"), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("--kuhn"), std::string::npos) << result.err;
    EXPECT_FALSE(std::filesystem::exists(vtu));
}

TEST(Tetrahedralizer, NamesItsLicence) {
    if (!with_tetgen()) GTEST_SKIP() << "built without TetGen";
    for (const char* option : {"--help", "--version"}) {
        const ProgramResult result = run_program({LAMINA_TETRAHEDRALIZE_BINARY, option});
        EXPECT_EQ(result.exit_code, 0);
        EXPECT_EQ(result.out.find("lamina-tetrahedralize"), 0u);
        EXPECT_TRUE(result.out.find("AGPL") != std::string::npos ||
                    result.out.find("Affero") != std::string::npos);
    }
    const ProgramResult empty = run_program({LAMINA_TETRAHEDRALIZE_BINARY});
    EXPECT_EQ(empty.exit_code, 1);
    EXPECT_EQ(empty.err, "lamina-tetrahedralize: stdin: no count of points\n");
    EXPECT_EQ(run_program({LAMINA_TETRAHEDRALIZE_BINARY, "points"}).exit_code, 2);
}

}  // namespace
}  // namespace lamina
