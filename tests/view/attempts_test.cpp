// SPDX-License-Identifier: Apache-2.0
#include "model/attempts.h"

#include <gtest/gtest.h>

#include "lamina/error.h"
#include "lamina/scene.h"
#include "model/document.h"
#include "model/factors_text.h"
#include "support/temporary_folder.h"

namespace lamina::view {
namespace {

Scene small_scene(const std::string& render = "{}") {
    return parse_scene(R"({"version": 1, "volume": {"generate": "gaussians"},
                           "transfer_function": {"points": [{"value": 0, "extinction": 1}]},
                           "camera": {"eye": [3, 1, 2], "center": [0.5, 0.5, 0.5]},
                           "render": )" +
                           render + "}",
                       "scene.json");
}

Scene moved(Scene scene) {
    scene.camera->eye.x += 1;
    return scene;
}

void add(Attempts& attempts, const Scene& scene, double ms = 1) {
    FrameStatistics statistics;
    statistics.draw_ms = ms;
    statistics.stages_ms = {{"facts", .5 * ms}, {"draw", .25 * ms}, {"order", .125 * ms}};
    attempts.add(scene, scene, 2.5, statistics);
}

TEST(Attempts, EachSceneHasOneRow) {
    Attempts attempts;
    const Scene first = small_scene(R"({"target": "fixed8"})"), second = small_scene();
    add(attempts, first, 10);
    attempts.measured(.5, {3, 0, 1});
    add(attempts, second, 20);
    attempts.measured(1, {.05, 0, .01});
    ASSERT_EQ(attempts.rows().size(), 2u);
    EXPECT_EQ(attempts.newest(), 1u);
    add(attempts, first, 11);
    ASSERT_EQ(attempts.rows().size(), 2u);
    EXPECT_EQ(attempts.newest(), 0u);
    EXPECT_EQ(attempts.rows()[0].draw_ms, 11);
    EXPECT_EQ(attempts.rows()[0].frame_ms, .375 * 11);
    // Drawing the first scene again starts its trace anew: the row keeps its error until a larger
    // share of the pixels is measured again.
    attempts.measured(.25, {2, 0, 1});
    EXPECT_EQ(attempts.rows()[0].share_measured, .5);
    EXPECT_EQ(attempts.rows()[0].error.linf, 3);
    attempts.measured(.75, {4, 0, 1});
    EXPECT_EQ(attempts.rows()[0].error.linf, 4);
    EXPECT_EQ(attempts.rows()[1].error.linf, .05);
}

TEST(Attempts, OnlyFullyMeasuredRowsStayInAnotherView) {
    Attempts attempts;
    const Scene scene = small_scene();
    add(attempts, scene);
    attempts.measured(.9, {1, 0, 1});
    add(attempts, moved(scene));
    ASSERT_EQ(attempts.rows().size(), 1u);
    EXPECT_EQ(attempts.rows()[0].share_measured, 0);
    EXPECT_EQ(attempts.rows()[0].view, 2);
    attempts.measured(1, {1, 0, 1});
    add(attempts, moved(moved(scene)));
    ASSERT_EQ(attempts.rows().size(), 2u);
    EXPECT_EQ(attempts.rows()[1].view, 3);
    add(attempts, moved(scene));
    EXPECT_EQ(attempts.newest(), 0u);
    EXPECT_EQ(attempts.rows().size(), 2u);
}

TEST(Attempts, DescribesAttemptsInShort) {
    const Scene slices = small_scene(R"({"target": "fixed8", "slice": {"samples": 512,
        "classification": "post", "tree": {"factors": [16, 32], "code": "phi"}}})");
    EXPECT_EQ(short_text(slices), "slice, post, fixed8, tree 16x32, phi, 512 slabs");
    const Scene tets = parse_scene(R"({"version": 1, "mesh": "a.vtu",
        "render": {"method": "project", "project": {"interpolation": "linear"}}})",
                                   "scene.json");
    EXPECT_EQ(short_text(tets), "project, preintegrated, linear, float32");
    EXPECT_EQ(short_text(small_scene(R"({"method": "trace"})")), "trace, volume");
}

TEST(Attempts, FindsThoseThatDifferInTheTreeAlone) {
    Attempts attempts;
    const Scene scene = small_scene(R"({"target": "fixed8", "slice": {"samples": 512}})");
    add(attempts, scene);
    add(attempts, with_factors(scene, "[16, 32]"));
    add(attempts, small_scene(R"({"target": "float16", "slice": {"samples": 512}})"));
    add(attempts, with_factors(scene, "8^3"));
    EXPECT_EQ(attempts.alike(without_tree), (std::vector<std::size_t>{0, 1, 3}));
}

// Returns the rows of cells that a spreadsheet reads from the text (RFC 4180).
std::vector<std::vector<std::string>> cells_of(const std::string& csv) {
    std::vector<std::vector<std::string>> rows(1, std::vector<std::string>(1));
    bool quoted = false;
    for (std::size_t i = 0; i < csv.size(); ++i) {
        if (csv[i] == '"') {
            if (quoted && csv[i + 1] == '"')
                rows.back().back() += csv[i++];
            else
                quoted = !quoted;
        } else if (csv[i] == ',' && !quoted) {
            rows.back().emplace_back();
        } else if (csv[i] == '\n' && !quoted) {
            rows.emplace_back(1);
        } else if (csv[i] != '\r') {
            rows.back().back() += csv[i];
        }
    }
    rows.pop_back();
    return rows;
}

TEST(Attempts, CsvHasEveryAttempt) {
    Attempts attempts;
    const Scene scene = small_scene(R"({"target": "fixed8", "max_error": 2,
                                        "slice": {"samples": 64, "tree": {"factors": [8, 8]}}})");
    add(attempts, small_scene());
    FrameStatistics statistics;
    statistics.draw_ms = 12.5;
    statistics.stages_ms = {{"draw", 8}, {"plan", 3}, {"geometry", 1.5}};
    attempts.add(scene, scene, std::nullopt, statistics);
    attempts.measured(.25, {3.5, -.125, .5});
    const auto rows = cells_of(attempts.csv());
    ASSERT_EQ(rows.size(), 3u);
    for (const auto& row : rows) ASSERT_EQ(row.size(), 17u);
    EXPECT_EQ(rows[0][0], "view");
    EXPECT_EQ(rows[1][7], "2.5");
    EXPECT_EQ(rows[1][8], "");
    const std::vector<std::string> given(rows[2].begin(), rows[2].end() - 1);
    EXPECT_EQ(given,
              (std::vector<std::string>{"1", "slice", "auto", "fixed8", "8x8", "64", "2", "", "3.5",
                                        "-0.125", "0.5", "0.25", "12.5", "9.5", "800", "600"}));
    // The last cell is the complete scene.
    EXPECT_EQ(scene_text(parse_scene(rows[2].back(), "again.json")), scene_text(scene));
}

TEST(TextFile, IsWrittenInFullOrNotAtAll) {
    const TemporaryFolder folder;
    save_text(folder / "a.csv", "one\r\n");
    save_text(folder / "a.csv", "two\r\n");
    EXPECT_EQ(read_bytes_of(folder / "a.csv"), "two\r\n");
    std::filesystem::create_directory(folder / "taken");
    for (const auto& file : {folder / "no" / "a.csv", folder / "taken"}) {
        try {
            save_text(file, "x");
            ADD_FAILURE() << file;
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find(file.string()), std::string::npos);
        }
    }
    const auto entries = std::filesystem::directory_iterator(folder.path());
    EXPECT_EQ(std::distance(begin(entries), end(entries)), 2);  // no temporary file remains
}

}  // namespace
}  // namespace lamina::view
