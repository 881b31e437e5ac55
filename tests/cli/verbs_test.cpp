// SPDX-License-Identifier: Apache-2.0
// Rules that hold for every verb, and tests of the small verbs.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "cli/lamina_run.h"
#include "support/temporary_folder.h"

namespace lamina {
namespace {

using nlohmann::json;

TEST(Verbs, HelpGoesToStdoutAndNamesTheUsage) {
    for (const char* verb :
         {"", "render", "compare", "generate", "info", "integrate", "mesh", "order", "reproduce"}) {
        const ProgramResult result =
            std::string(verb).empty() ? lamina_run({"--help"}) : lamina_run({verb, "--help"});
        EXPECT_EQ(result.exit_code, 0);
        EXPECT_NE(result.out.find("Usage:"), std::string::npos) << verb;
        EXPECT_EQ(result.err, "");
    }
}

TEST(Verbs, VersionIsOneLineEverywhere) {
    for (const char* verb :
         {"", "render", "compare", "generate", "info", "integrate", "mesh", "order", "reproduce"}) {
        const ProgramResult result =
            std::string(verb).empty() ? lamina_run({"--version"}) : lamina_run({verb, "--version"});
        EXPECT_EQ(result.exit_code, 0) << verb;
        EXPECT_EQ(result.out.find("lamina "), 0u) << verb;
    }
}

TEST(Verbs, ResultsThatDoNotReachStdoutAreAFailure) {
    const std::string command =
        std::string("'") + LAMINA_BINARY + "' generate --help > /dev/full 2> /dev/null";
    EXPECT_EQ(run_program({"sh", "-c", command}).exit_code, 1);
}

TEST(Verbs, UnknownVerbsAndOptionsExitWith2) {
    EXPECT_EQ(lamina_run({}).exit_code, 2);
    EXPECT_EQ(lamina_run({"paint"}).exit_code, 2);
    EXPECT_EQ(lamina_run({"info"}).exit_code, 2);
    EXPECT_EQ(lamina_run({"generate", "teapot", "-o", "/tmp/x.nrrd"}).exit_code, 2);
}

TEST(Verbs, GenerateAndInfoAgree) {
    const TemporaryFolder folder;
    const std::string file = folder / "m.nrrd";
    ASSERT_EQ(
        lamina_run({"generate", "mixing", "-o", file, "--size", "20,24,28", "--type", "uint16"})
            .exit_code,
        0);
    const ProgramResult result = lamina_run({"info", file, "--json", "--png", folder / "m.png"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const json info = json::parse(result.out);
    EXPECT_EQ(info["kind"], "volume");
    EXPECT_EQ(info["size"], json({20, 24, 28}));
    EXPECT_EQ(info["type"], "uint16");
    EXPECT_EQ(info["centers"], "node");
    EXPECT_EQ(info["bounds"]["min"], json({0., 0., 0.}));
    EXPECT_NEAR(info["bounds"]["max"][0].get<double>(), 1, 1e-12);
    EXPECT_EQ(info["nan_count"], 0);
    EXPECT_TRUE(std::filesystem::exists(folder / "m.png"));
}

TEST(Verbs, RampIsWhatThePapersTestsNeed) {
    const TemporaryFolder folder;
    const std::string file = folder / "ramp.nrrd";
    ASSERT_EQ(lamina_run({"generate", "ramp", "-o", file}).exit_code, 0);
    const json info = json::parse(lamina_run({"info", file, "--json"}).out);
    EXPECT_EQ(info["size"], json({256, 4, 1}));
    EXPECT_EQ(info["centers"], "cell");
    EXPECT_EQ(info["range"], json({0, 255}));
    EXPECT_EQ(info["bounds"]["max"][2].get<double>() - info["bounds"]["min"][2].get<double>(), 1);
}

TEST(Verbs, IntegrateGivesTheClosedForm) {
    const TemporaryFolder folder;
    write_bytes_to(folder / "cases.json",
                   R"([{"transfer_function": {"points": [{"value": 0, "color": [1, 0.5, 0],
        "extinction": 2}]}, "sf": 0, "sb": 1, "length": 1.5}])");
    const ProgramResult result = lamina_run({"integrate", folder / "cases.json"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const json answer = json::parse(result.out);
    EXPECT_NEAR(answer[0]["alpha"].get<double>(), -std::expm1(-3.), 1e-15);
    EXPECT_NEAR(answer[0]["color"][1].get<double>(), -.5 * std::expm1(-3.), 1e-15);
    write_bytes_to(folder / "bad.json", R"([{"sf": 0}])");
    EXPECT_EQ(lamina_run({"integrate", folder / "bad.json"}).exit_code, 1);
}

}  // namespace
}  // namespace lamina
