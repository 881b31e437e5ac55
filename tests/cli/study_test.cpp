// SPDX-License-Identifier: Apache-2.0
// lamina study: its results.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "cli/study_test_case.h"
#include "image/exr.h"

namespace lamina {
namespace {

using nlohmann::json;

class Study : public StudyTestCase {
  protected:
    Image picture_of(const CsvRow& row) const {
        return read_exr(folder / "out" / "pictures" / (row.at("run") + ".exr"));
    }

    // Returns the errors of the run's scene by lamina render and lamina compare with --method
    // trace.
    json errors_by_hand(const CsvRow& row) {
        const std::string scene = folder / (row.at("scene") + ".json");
        const std::string of = row.at("render.method") == "project" ? "mesh" : "volume";
        const std::string picture = folder / "picture.exr", traced = folder / "traced.npy";
        const ProgramResult drawn =
            lamina_run({"render", scene, "-o", picture, "--context", "cpu", "--set",
                        "render.method=" + row.at("render.method"), "--set",
                        "render.target=" + row.at("render.target")});
        EXPECT_EQ(drawn.exit_code, 0) << drawn.err;
        const ProgramResult reference =
            lamina_run({"render", scene, "-o", traced, "--method", "trace", "--set",
                        "render.trace.of=" + of, "--set", "render.trace.tolerance=1e-6"});
        EXPECT_EQ(reference.exit_code, 0) << reference.err;
        EXPECT_EQ(read_exr(picture).rgba, picture_of(row).rgba);
        return json::parse(lamina_run({"compare", picture, traced, "--json"}).out);
    }
};

double number(const CsvRow& row, const std::string& column) {
    return std::stod(row.at(column));
}

TEST_F(Study, WritesARowARunAndAReport) {
    const ProgramResult result = run_well("out");
    EXPECT_NE(result.err.find("2 runs left out: the ramp has no tets"), std::string::npos);
    EXPECT_NE(result.out.find("Pareto front"), std::string::npos);
    // The program says how much there is to do before it begins, and how long it takes after each
    // first round.
    const std::size_t count =
        result.err.find("study.json: 6 runs of 2 scenes, each timed in 2 rounds of 6 frames");
    const std::size_t ramps = result.err.find("ramp: first round of 2 runs done: about ");
    const std::size_t first_blobs = result.err.find("blobs: first round of 4 runs done: about ");
    EXPECT_LT(count, ramps) << result.err;
    EXPECT_LT(ramps, first_blobs) << result.err;
    EXPECT_NE(first_blobs, std::string::npos) << result.err;
    const std::vector<CsvRow> rows = results("out");
    ASSERT_EQ(rows.size(), 6u);
    const std::string text = read_bytes_of(folder / "out" / "results.csv");
    EXPECT_TRUE(text.starts_with("scene,render.method,render.target,frame_ms_median,frame_ms_min,"))
        << text;
    for (const char* column : {"frame_ms_median", "frame_ms_min", "linf", "l1", "l2", "bytes"}) {
        for (const CsvRow& row : rows) EXPECT_NO_THROW(number(row, column)) << column;
    }
    expect_every_run_once("out");
    const json report = document("out", "results.json");
    EXPECT_EQ(report["kind"], "study");
    EXPECT_EQ(report["title"], "tiny");
    EXPECT_EQ(report["swept"], json({"render.method", "render.target"}));
    EXPECT_EQ(report["base"], study["base"]);
    EXPECT_EQ(report["comparisons"][1]["set"], json::object());
    for (const char* key : {"machine", "processors", "drivers", "version", "commit", "command"})
        EXPECT_FALSE(report["environment"][key].get<std::string>().empty()) << key;
    ASSERT_EQ(report["comparisons"].size(), 2u);
    EXPECT_EQ(report["dropped"],
              json::parse(R"([{"because": "the ramp has no tets", "runs": 2}])"));
    const std::string page = read_bytes_of(folder / "out" / "report.html");
    EXPECT_NE(page.find("<html"), std::string::npos);
    EXPECT_NE(page.find("\"first_ms\":"), std::string::npos);
    for (const CsvRow& row : rows) EXPECT_NE(page.find(row.at("run")), std::string::npos);
    EXPECT_EQ(run("quiet", {"--quiet"}).err, "");
}

TEST_F(Study, TimesAreInOrderAndRatiosAreToTheBaseline) {
    study["baseline"] = {{"render.method", "slice"}, {"render.target", "fixed8"}};
    run_well("out");
    for (const CsvRow& row : results("out")) {
        for (const std::string kind : {"frame_ms", "still_ms"}) {
            EXPECT_GT(number(row, kind + "_min"), 0);
            EXPECT_LE(number(row, kind + "_min"), number(row, kind + "_median"));
            EXPECT_LE(number(row, kind + "_median"), number(row, kind + "_max"));
        }
        EXPECT_GT(number(row, "first_ms"), 0);
        if (row.at("name") == "slice, fixed8")
            EXPECT_EQ(number(row, "ratio"), 1);
        else
            EXPECT_GT(number(row, "ratio"), 0);
    }
    const json report = document("out", "results.json");
    for (const json& comparison : report["comparisons"]) {
        for (const json& each : comparison["runs"]) {
            if (each["id"] == comparison["baseline"]) {
                EXPECT_EQ(each["name"], "slice, fixed8");
            }
            EXPECT_GT(each["first_ms"], each["stages"]["set_up"]);
        }
    }
}

TEST_F(Study, ErrorsAreThoseOfRenderAndCompare) {
    run_well("out");
    for (const CsvRow& row : results("out")) {
        const json errors = errors_by_hand(row);
        for (const std::string norm : {"linf", "l1", "l2"}) {
            // Both compute the same sums of the same pictures and print all digits.
            EXPECT_EQ(number(row, norm), errors["all"][norm].get<double>())
                << row.at("scene") << " " << row.at("name") << " " << norm;
            for (const std::string channel : {"R", "G", "B", "A"}) {
                EXPECT_EQ(number(row, norm + "_" + channel),
                          errors["channels"][channel][norm].get<double>());
            }
        }
    }
}

// Finds the Pareto front again, by comparing all pairs of rows.
TEST_F(Study, ParetoColumnIsTheFrontOfTheTable) {
    study["sweep"]["render.slice.samples"] = {4, 8, 16, 32, 64};
    study["drop"].push_back(
        {{"where", {{"render.method", "project"}, {"render.slice.samples", {4, 8, 16, 32}}}},
         {"because", "PT has no slabs"}});
    run_well("out");
    const std::vector<CsvRow> rows = results("out");
    ASSERT_EQ(rows.size(), 10u + 12);
    std::set<std::string> scenes_with_front;
    for (const CsvRow& row : rows) {
        bool beaten = false;
        for (const CsvRow& other : rows) {
            if (other.at("scene") != row.at("scene")) continue;
            const double ms = number(other, "frame_ms_median") - number(row, "frame_ms_median");
            const double error = number(other, "l2") - number(row, "l2");
            beaten |= ms <= 0 && error <= 0 && (ms < 0 || error < 0);
        }
        EXPECT_EQ(row.at("pareto"), beaten ? "false" : "true") << row.at("name");
        if (!beaten) scenes_with_front.insert(row.at("scene"));
    }
    EXPECT_EQ(scenes_with_front.size(), 2u);
}

TEST_F(Study, ARunThatFailsIsRecordedAndTheOthersFinish) {
    study["base"]["render.target"] = "fixed8";
    study["sweep"] = json::parse(R"({"render.slice.tree": [
        {"factors": [8, 8], "nodes": "shader"},
        {"factors": [8, 8], "nodes": "fixed"},
        "bonsai"]})");
    study["drop"] = json::array();
    const ProgramResult result = run_well("out");
    const std::vector<CsvRow> rows = results("out");
    ASSERT_EQ(rows.size(), 6u);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const CsvRow& row = rows[i];
        // The ramp is grey, so fixed nodes can draw it. The third value is no valid tree for any
        // scene.
        const bool fails = i == 2 || i == 4 || i == 5;
        EXPECT_EQ(row.at("failed").empty(), !fails) << i << row.at("failed");
        EXPECT_EQ(row.at("l2").empty(), fails);
        EXPECT_EQ(row.at("pareto").empty(), fails);
        EXPECT_EQ(row.at("scene"), i < 3 ? "ramp" : "blobs");
    }
    EXPECT_NE(rows[4].at("failed").find("several colours"), std::string::npos);
    EXPECT_NE(rows[5].at("failed").find("\"bonsai\""), std::string::npos);
    EXPECT_NE(result.err.find("several colours"), std::string::npos);
    EXPECT_NE(result.err.find("3 of them failed"), std::string::npos);
    const json report = document("out", "results.json");
    EXPECT_EQ(report["comparisons"][1]["runs"][1]["failed"], rows[4].at("failed"));
    EXPECT_NE(read_bytes_of(folder / "out" / "report.html").find("several colours"),
              std::string::npos);
}

TEST_F(Study, ReferencesAreKeptForLaterStudies) {
    run_well("out");
    const auto before = contents(folder / "out" / "references");
    // A picture and its facts for each of: ramp, blobs, the mesh of blobs.
    EXPECT_EQ(before.size(), 2u * 3);
    const json report = document("out", "results.json");
    for (const json& comparison : report["comparisons"]) {
        for (const json& reference : comparison["references"])
            EXPECT_GE(reference["error_estimate"], 0);
    }
    // Files that contain the time of tracing stay as they are, so nothing is traced again.
    run_well("out", {"--resume"});
    EXPECT_EQ(contents(folder / "out" / "references"), before);
}

TEST_F(Study, ANullDrawsWhatTheSceneWithoutTheKeyDoes) {
    study["scenes"] = {"blobs.json"};
    study["drop"] = json::array();
    study["sweep"] = {{"render.slice.samples", {24, nullptr}}};
    blobs["render"]["slice"]["samples"] = 3;
    run_well("out");
    const std::vector<CsvRow> rows = results("out");
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_EQ(rows[1].at("failed"), "");
    EXPECT_EQ(rows[1].at("render.slice.samples"), "");
    const std::string picture = folder / "a.exr";
    ASSERT_EQ(lamina_run({"render", folder / "blobs.json", "-o", picture, "--context", "cpu",
                          "--set", "render.slice.samples=auto"})
                  .exit_code,
              0);
    EXPECT_EQ(read_exr(picture).rgba, picture_of(rows[1]).rgba);
}

TEST_F(Study, ContextsAreSwept) {
    study["sweep"] = {{"context", {"cpu", "osmesa"}}};
    study["drop"] = json::array();
    run_well("out");
    const std::vector<CsvRow> rows = results("out");
    ASSERT_EQ(rows.size(), 4u);
    for (const CsvRow& row : rows) {
        EXPECT_EQ(row.at("failed"), "");
        EXPECT_EQ(row.at("renderer").starts_with("cpu"), row.at("context") == "cpu");
        // OpenGL's bytes are counted in bytes_gpu, which is 0 for the cpu engine.
        EXPECT_EQ(number(row, "bytes_gpu") > 0, row.at("context") == "osmesa");
    }
}

ProgramResult run_without_data(const std::vector<std::string>& arguments) {
    return run_program(arguments, [] { unsetenv("LAMINA_DATA"); });
}

// The other scene is drawn, and the page says which scene is skipped and what to set.
TEST_F(Study, ScenesWithoutTheirDataSetAreSkipped) {
    blobs["volume"] = "${LAMINA_DATA}/bonsai.nrrd";
    const std::string wanted =
        "scene \"blobs\" is skipped: set LAMINA_DATA to the folder with the data sets";
    const ProgramResult result = run_without_data(command("out"));
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.err.find("4 runs left out: " + wanted), std::string::npos) << result.err;
    for (const CsvRow& row : results("out")) EXPECT_EQ(row.at("scene"), "ramp");
    EXPECT_EQ(document("out", "results.json")["dropped"].back(),
              json({{"because", wanted}, {"runs", 4}}));
}

TEST_F(Study, WithoutAnyDataSetThereIsAPageThatSaysSo) {
    ramp["volume"] = blobs["volume"] = "${LAMINA_DATA}/bonsai.nrrd";
    const ProgramResult result = run_without_data(command("out"));
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const std::string page = read_bytes_of(folder / "out" / "report.html");
    EXPECT_NE(page.find("set LAMINA_DATA to the folder with the data sets"), std::string::npos);
    EXPECT_TRUE(results("out").empty());
}

}  // namespace
}  // namespace lamina
