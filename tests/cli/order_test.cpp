// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "cli/run_program.h"
#include "support/temporary_folder.h"

namespace lamina {
namespace {

using nlohmann::json;

// Writes two tets with a gap between them; in some views one is behind the other.
std::string two_tets(const TemporaryFolder& folder) {
    std::ofstream(folder.path() / "two.node") << "8 3 1 0\n0 0 0 0 1\n1 1 0 0 1\n2 0 1 0 1\n"
                                                 "3 0 0 1 1\n4 0 0 2 1\n5 1 0 2 1\n6 0 1 2 1\n"
                                                 "7 0 0 3 1\n";
    std::ofstream(folder.path() / "two.ele") << "2 4 0\n0 0 1 2 3\n1 4 5 6 7\n";
    return (folder.path() / "two.node").string();
}

ProgramResult order(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {LAMINA_BINARY, "order"});
    return run_program(arguments);
}

TEST(Order, JsonHasEveryMethod) {
    const TemporaryFolder folder;
    const ProgramResult result =
        order({two_tets(folder), "--json", "--eyes", "8", "--size", "30x20"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err, "");
    const json report = json::parse(result.out);
    EXPECT_EQ(report["tets"], 2);
    EXPECT_EQ(report["convex"], false);
    EXPECT_EQ(report["eyes"], 8);
    const char* const names[] = {"mpvo", "exact", "centroid", "none"};
    ASSERT_EQ(report["orders"].size(), 4u);
    for (std::size_t i = 0; i < 4; ++i) {
        const json& found = report["orders"][i];
        EXPECT_EQ(found["order"], names[i]);
        EXPECT_EQ(found["face_violations"], 0);  // no shared face
        EXPECT_EQ(found["cycles"], 0);
        EXPECT_GT(found["covered_pixels"], 100);
        EXPECT_LE(found["wrong_pixels"], found["covered_pixels"]);
    }
    EXPECT_EQ(report["orders"][1]["wrong_pixels"], 0);
    EXPECT_GT(report["orders"][3]["wrong_pixels"], 0);
}

TEST(Order, TableNamesWhatItMeasures) {
    const TemporaryFolder folder;
    const ProgramResult result = order({two_tets(folder), "--eyes", "1", "--size", "8x8"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    for (const char* word : {"2 tets, not convex; 1 views", "mpvo", "exact", "centroid", "none",
                             "wrong pixels", "cyclic tets"})
        EXPECT_NE(result.out.find(word), std::string::npos) << word;
}

TEST(Order, UsesTheCameraOfAScene) {
    const TemporaryFolder folder;
    two_tets(folder);
    const auto covered = [&](const std::string& eye) {
        std::ofstream(folder.path() / "scene.json")
            << R"({"version": 1, "mesh": "two.node", "image": {"width": 9, "height": 9},
                   "transfer_function": {"points": [{"value": 1, "color": [1, 1, 1], "opacity": 1}]},
                   "camera": {"eye": )"
            << eye << R"(, "center": [0.2, 0.2, 1]}, "render": {"method": "trace"}})";
        const ProgramResult result = order(
            {(folder.path() / "scene.json").string(), "--json", "--eyes", "1", "--size", "20x20"});
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return json::parse(result.out)["orders"][0]["covered_pixels"].get<int>();
    };
    EXPECT_GT(covered("[4, 0.2, 1]"), 4 * covered("[40, 0.2, 1]"));
}

TEST(Order, NamesMistakes) {
    const TemporaryFolder folder;
    const std::string mesh = two_tets(folder);
    for (const char* size : {"", "30", "30x", "x30", "0x5", "-1x5", "30x20x10", "99999x5"}) {
        const ProgramResult result = order({mesh, "--size", size});
        EXPECT_EQ(result.exit_code, 2) << size;
        EXPECT_NE(result.err.find("--size"), std::string::npos) << result.err;
    }
    EXPECT_EQ(order({mesh, "--eyes", "0"}).exit_code, 2);
    EXPECT_EQ(order({}).exit_code, 2);
    const ProgramResult unknown = order({"picture.png"});
    EXPECT_EQ(unknown.exit_code, 1);
    EXPECT_NE(unknown.err.find("picture.png: no such file"), std::string::npos);
    EXPECT_EQ(order({(folder.path() / "none.vtu").string()}).exit_code, 1);
}

}  // namespace
}  // namespace lamina
