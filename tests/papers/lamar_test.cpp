// SPDX-License-Identifier: Apache-2.0
#include "papers/lamar.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "papers/findings.h"
#include "support/temporary_folder.h"

namespace lamina::papers {
namespace {

using Json = nlohmann::ordered_json;

TEST(Findings, NameWhatDoesNotHold) {
    Findings findings;
    findings.add("water is wet", true, "it is");
    EXPECT_TRUE(findings.agree());
    EXPECT_EQ(findings.result(1)["note"], "Agrees.");
    findings.add("fire is cold", false, "900 degrees");
    const Json result = findings.result({{"a", 1}}, 7, "More.");
    EXPECT_EQ(result["agrees"], false);
    EXPECT_EQ(result["note"], "Disagrees: \"fire is cold\": 900 degrees. More.");
    EXPECT_EQ(result["paper"], Json({{"printed", 7}, {"says", {"water is wet", "fire is cold"}}}));
    EXPECT_EQ(result["values"]["a"], 1);
}

// The long items, `order` and `dithering`, run in the test of the command line; one that draws, in
// lamar_drawn_test.cpp.
TEST(Lamar, EveryItemHasItsKeysAndWritesItsFiles) {
    for (const LamarItem& item : lamar_items()) {
        ASSERT_NE(item.reproduce == nullptr, item.draw == nullptr) << item.name;
        if (item.draw != nullptr || item.name == "order" || item.name == "dithering") continue;
        const TemporaryFolder folder;
        const Json result = item.reproduce(folder.path());
        for (const char* key : {"values", "paper", "agrees", "note", "checks"}) {
            EXPECT_TRUE(result.contains(key)) << item.name << " " << key;
        }
        EXPECT_TRUE(result["agrees"].is_boolean());
        EXPECT_FALSE(result["checks"].empty()) << item.name;
        ASSERT_FALSE(result["values"]["files"].empty()) << item.name;
        EXPECT_EQ(result["values"]["files"], Json(item.files)) << item.name;
        for (const Json& file : result["values"]["files"]) {
            EXPECT_GT(std::filesystem::file_size(folder / file.get<std::string>()), 0u);
        }
    }
}

TEST(Lamar, Table1AgreesButForItsCaption) {
    const TemporaryFolder folder;
    const Json table = reproduce_table1(folder.path());
    EXPECT_EQ(table["agrees"], true);
    EXPECT_EQ(table["values"]["caption_d_holds"], false);
    std::vector<int> buffer;
    for (const Json& row : table["values"]["rows"]) buffer.push_back(row["buffer"]);
    // docs/numerics.md, "Where the papers are wrong".
    EXPECT_EQ(buffer, (std::vector<int>{0, 0, 64, 64, 96, 136, 183, 220, 255}));
    EXPECT_EQ(table["values"]["rows"][4]["c"], ".00000010 11000001");
    EXPECT_EQ(table["values"]["rows"][4]["d"], "0.3946590");
}

TEST(Lamar, Table2IsThePapers) {
    const TemporaryFolder folder;
    const Json table = reproduce_table2(folder.path());
    EXPECT_EQ(table["agrees"], true);
    EXPECT_EQ(table["values"]["rows"][0],
              Json({0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15}));
    EXPECT_EQ(table["values"]["rows"][8][1], 8);  // the paper: [8,1] => 8
}

TEST(Lamar, Table3HasOneMisprint) {
    const TemporaryFolder folder;
    const Json table = reproduce_table3(folder.path());
    EXPECT_EQ(table["agrees"], false);
    EXPECT_EQ(table["values"]["misprints"],
              Json::array({{{"f", 4}, {"iteration", 4}, {"printed", 10}, {"correct", 11}}}));
    EXPECT_EQ(table["values"]["rows"][3]["b"], Json({4, 7, 9, 11, 12, 13, 14}));
    EXPECT_EQ(table["values"]["rows"][1]["b"], table["paper"]["printed"][1]["b"]);
}

TEST(Lamar, Figure3FusedNeverDecreases) {
    const TemporaryFolder folder;
    const Json figure = reproduce_figure3(folder.path());
    EXPECT_EQ(figure["agrees"], true);
    for (const char* depth : {"N=16", "N=64", "N=256"}) {
        EXPECT_EQ(figure["values"]["decreases"][std::string(depth) + " fused"], 0);
        EXPECT_GT(figure["values"]["decreases"][std::string(depth) + " separate"], 0);
    }
}

TEST(Lamar, DitheringRecoversFigure4) {
    const TemporaryFolder folder;
    const Json errors = reproduce_figure4(folder.path())["values"]["errors"];
    EXPECT_LT(errors["dithered, period 11"]["l2"], errors["hardware"]["l2"]);
}

TEST(Lamar, Figure9FallsWithRegularityAndHeight) {
    const TemporaryFolder folder;
    const Json figure = reproduce_figure9(folder.path());
    EXPECT_EQ(figure["agrees"], true);
    const Json errors = figure["values"]["errors"];
    for (const char* norm : {"linf", "l2"}) {
        EXPECT_LT(errors["64x4"][norm], errors["256"][norm]);
        EXPECT_LT(errors["16x16"][norm], errors["64x4"][norm]);
        EXPECT_LT(errors["16x16"][norm], errors["4x64"][norm]);
        EXPECT_LT(errors["4x4x4x4"][norm], errors["16x16"][norm]);
    }
}

}  // namespace
}  // namespace lamina::papers
