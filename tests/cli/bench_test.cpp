// SPDX-License-Identifier: Apache-2.0
// tools/bench on the command line.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cli/blobs_scene.h"
#include "cli/run_program.h"
#include "support/temporary_folder.h"

namespace lamina {
namespace {

using nlohmann::json;

class Bench : public testing::Test {
  protected:
    void SetUp() override {
        if (run_program({"python3", "--version"}).exit_code != 0) GTEST_SKIP() << "no python3";
        json scene = gaussians_scene(24, 40, 30, 60);
        write_bytes_to(folder / "here.json", scene.dump());
        scene["volume"] = "${LAMINA_DATA}/nothing.nrrd";
        write_bytes_to(folder / "gone.json", scene.dump());
    }

    ProgramResult bench(const std::vector<std::string>& options) const {
        std::vector<std::string> arguments{"env", "LAMINA_DATA=" + folder.path().string(),
                                           LAMINA_SOURCE_DIR "/tools/bench", "--lamina",
                                           LAMINA_BINARY};
        arguments.insert(arguments.end(), options.begin(), options.end());
        return run_program(arguments);
    }

    TemporaryFolder folder;
};

TEST_F(Bench, TimesScenesThatAreThereAndNamesWhatIsMissing) {
    const std::string scenes =
        (folder / "gone.json").string() + "," + (folder / "here.json").string();
    const ProgramResult result = bench({"--scenes", scenes, "--no-omit", "--frames", "2",
                                        "--rounds", "3", "--json", folder / "out.json"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.out.find((folder / "nothing.nrrd").string() + ": no such file"),
              std::string::npos)
        << result.out;
    const json document = json::parse(read_bytes_of(folder / "out.json"));
    ASSERT_EQ(document["scenes"].size(), 1u);
    const json& ways = document["scenes"][0]["ways"];
    ASSERT_EQ(ways.size(), 2u);
    EXPECT_EQ(ways[0]["name"], "cpu --no-omit");
    EXPECT_EQ(ways[0]["stats"]["omitted"].size(), 0u);
    EXPECT_EQ(ways[1]["name"], "cpu");
    EXPECT_GT(ways[1]["stats"]["omitted"].size(), 0u);
    for (const json& way : ways) {
        std::vector<double> times = way["rounds_ms"];
        ASSERT_EQ(times.size(), 3u);
        std::ranges::sort(times);
        EXPECT_EQ(way["ms"], times[1]);
        EXPECT_EQ(way["stats"]["frame_ms"]["n"], 2);
        std::vector<double> first = way["rounds_first_picture_ms"];
        ASSERT_EQ(first.size(), 3u);
        EXPECT_EQ(first.back(), way["stats"]["first_picture_ms"]);
        std::ranges::sort(first);
        EXPECT_EQ(way["first_picture_ms"], first[1]);
    }
    std::vector<double> ratios;
    for (std::size_t i = 0; i < 3; ++i)
        ratios.push_back(ways[0]["rounds_ms"][i].get<double>() /
                         ways[1]["rounds_ms"][i].get<double>());
    std::ranges::sort(ratios);
    EXPECT_EQ(ways[1]["times_as_fast"]["min"], ratios[0]);
    EXPECT_EQ(ways[1]["times_as_fast"]["median"], ratios[1]);
    EXPECT_EQ(ways[1]["times_as_fast"]["max"], ratios[2]);
}

TEST_F(Bench, KeepsAHistoryThatIsDrawn) {
    const std::string history = folder / "history.jsonl", page = folder / "page.html";
    const auto timed = [&](const std::string& width) {
        const ProgramResult result =
            bench({"--scenes", folder / "here.json", "--frames", "1", "--rounds", "1", "--history",
                   history, "--", "--set", "image.width=" + width});
        EXPECT_EQ(result.exit_code, 0) << result.err;
    };
    const auto drawn = [&] {
        return run_program({LAMINA_SOURCE_DIR "/tools/bench_history", history, "-o", page});
    };
    timed("40");
    timed("30");
    timed("30");
    ASSERT_EQ(drawn().exit_code, 0);
    const std::string text = read_bytes_of(page);
    EXPECT_NE(text.find("<h2>here</h2>"), std::string::npos);
    EXPECT_NE(text.find("image.width=30"), std::string::npos);
    EXPECT_NE(text.find("1 runs of other machines or arguments"), std::string::npos);
    // The history has two measurements: two points of one curve, the first at 1.
    std::size_t points = 0;
    for (std::size_t at = 0; (at = text.find("<circle", at)) != std::string::npos; ++at) ++points;
    EXPECT_EQ(points, 2u);
    EXPECT_NE(text.find("cpu: 1.000 at "), std::string::npos);
    write_bytes_to(history, read_bytes_of(history) + "{}\n");
    const ProgramResult broken = drawn();
    EXPECT_EQ(broken.exit_code, 1);
    EXPECT_NE(broken.err.find("history.jsonl, line 4: expected a run"), std::string::npos)
        << broken.err;
}

TEST_F(Bench, ListsTheStandardSet) {
    const ProgramResult result = bench({"--list"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.out.find("gaussians        ready"), std::string::npos) << result.out;
    EXPECT_NE(result.out.find("bonsai.nrrd: no such file"), std::string::npos) << result.out;
}

TEST_F(Bench, ReportsMistakesInOneLine) {
    const ProgramResult unknown = bench({"--scenes", "nosuchscene"});
    EXPECT_EQ(unknown.exit_code, 1);
    EXPECT_EQ(std::count(unknown.err.begin(), unknown.err.end(), '\n'), 1) << unknown.err;
    const ProgramResult refused = bench({"--scenes", folder / "here.json", "--contexts", "abacus"});
    EXPECT_EQ(refused.exit_code, 1);
    EXPECT_NE(refused.err.find("abacus"), std::string::npos) << refused.err;
    EXPECT_EQ(std::count(refused.err.begin(), refused.err.end(), '\n'), 1) << refused.err;
}

}  // namespace
}  // namespace lamina
