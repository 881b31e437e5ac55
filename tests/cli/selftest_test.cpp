// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/lamina_run.h"
#include "support/temporary_folder.h"

namespace lamina {
namespace {

// Sets an environment variable for the programs that a test starts.
class Environment {
  public:
    Environment(const char* name, const std::string& value) : name_(name) {
        setenv(name, value.c_str(), 1);
    }
    ~Environment() { unsetenv(name_); }
    Environment(const Environment&) = delete;
    Environment& operator=(const Environment&) = delete;

  private:
    const char* name_;
};

nlohmann::json report_in(const std::filesystem::path& folder) {
    return nlohmann::json::parse(read_bytes_of(folder / "selftest.json"));
}

TEST(Selftest, WritesATableAndAReport) {
    const TemporaryFolder folder;
    const ProgramResult result = lamina_run({"selftest", "--group", "metamorphic", "--context",
                                             "cpu", "-o", (folder / "out").string()});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.out.find("cases passed"), std::string::npos);
    const nlohmann::json report = report_in(folder / "out");
    EXPECT_EQ(report["counts"]["passed"], report["cases"].size());
    EXPECT_EQ(report["context"].get<std::string>().rfind("cpu", 0), 0u);
    for (const nlohmann::json& each : report["cases"]) {
        EXPECT_LE(each["error"].get<double>(), each["bound"].get<double>()) << each["scene"];
        EXPECT_NE(each["about"], "");
    }
    const std::string table = read_bytes_of(folder / "out" / "selftest.txt");
    EXPECT_NE(result.out.find(table), std::string::npos);
}

// Changes the first coefficient of the shaders' opacity polynomial by 1 %: pictures of OpenGL are
// then wrong, and those of the tracers are not.
TEST(Selftest, FindsAMutatedShader) {
    const TemporaryFolder folder;
    std::string text =
        read_bytes_of(std::filesystem::path(LAMINA_SOURCE_DIR) / "shaders/optics/opacity.glsl");
    const std::string coefficient = "0.693147187926693";
    const std::size_t place = text.find(coefficient);
    ASSERT_NE(place, std::string::npos);
    text.replace(place, coefficient.size(), "0.7");
    std::filesystem::create_directories(folder / "shaders" / "optics");
    std::ofstream(folder / "shaders" / "optics" / "opacity.glsl") << text;
    const Environment shaders("LAMINA_SHADER_DIR", (folder / "shaders").string());
    const ProgramResult result = lamina_run(
        {"selftest", "--group", "numbers", "--context", "osmesa", "-o", (folder / "out").string()});
    EXPECT_EQ(result.exit_code, 3) << result.err;
    EXPECT_NE(result.out.find("failed: pixel"), std::string::npos);
    std::size_t failed = 0;
    const nlohmann::json report = report_in(folder / "out");
    for (const nlohmann::json& each : report["cases"]) {
        const bool traced = each["way"].get<std::string>().rfind("trace", 0) == 0;
        if (traced) {
            EXPECT_EQ(each["verdict"], "passed") << each["scene"];
        }
        if (each["verdict"] == "failed") ++failed;
    }
    EXPECT_GE(failed, 40u);  // most of 68; the others show nothing
}

TEST(Selftest, ProbesShadersInPlaceOfCases) {
    const TemporaryFolder folder;
    const std::string out = (folder / "out").string();
    const ProgramResult result =
        lamina_run({"selftest", "--probe", "20x10", "--context", "osmesa", "-o", out, "--quiet"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const nlohmann::json report =
        nlohmann::json::parse(read_bytes_of(folder / "out" / "probe.json"));
    EXPECT_EQ(report["width"], 20);
    EXPECT_EQ(report["height"], 10);
    EXPECT_EQ(report["context"].get<std::string>().rfind("OSMesa", 0), 0u);
    EXPECT_NE(result.out.find("arithmetic  compute"), std::string::npos) << result.out;
    EXPECT_FALSE(std::filesystem::exists(folder / "out" / "selftest.json"));
    const std::vector<std::vector<std::string>> mistakes{
        {"--probe", "20", "--context", "osmesa"},
        {"--probe", "0x10", "--context", "osmesa"},
        {"--probe", "20x10", "--context", "cpu"},
        {"--probe", "20x10", "--context", "osmesa", "--group", "optics"}};
    for (std::vector<std::string> arguments : mistakes) {
        arguments.insert(arguments.begin(), {"selftest", "-o", (folder / "no").string()});
        const ProgramResult refused = lamina_run(arguments);
        EXPECT_EQ(refused.exit_code, 2) << refused.err;
        EXPECT_NE(refused.err.find("--probe"), std::string::npos) << refused.err;
        EXPECT_FALSE(std::filesystem::exists(folder / "no"));
    }
}

TEST(Selftest, RefusesUnknownGroups) {
    const TemporaryFolder folder;
    const ProgramResult group =
        lamina_run({"selftest", "--group", "optic", "-o", (folder / "out").string()});
    EXPECT_EQ(group.exit_code, 2);
    EXPECT_NE(group.err.find("metamorphic"), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(folder / "out" / "selftest.json"));
}

}  // namespace
}  // namespace lamina
