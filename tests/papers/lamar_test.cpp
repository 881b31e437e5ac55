// SPDX-License-Identifier: Apache-2.0
#include "papers/lamar.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "papers/paper_item.h"
#include "support/temporary_folder.h"

namespace lamina::papers {
namespace {

using Json = nlohmann::ordered_json;

TEST(Findings, NameWhatDoesNotHold) {
    Findings findings;
    findings.add("water is wet", true, "it is");
    EXPECT_EQ(findings.verdict(), Verdict::agrees);
    EXPECT_EQ(findings.result(1)["note"], "Agrees.");
    findings.add("fire is cold", false, "900 degrees");
    const Json result = findings.result({{"a", 1}}, 7, "More.");
    EXPECT_EQ(result["agrees"], false);
    EXPECT_EQ(result["note"], "Disagrees: \"fire is cold\": 900 degrees. More.");
    EXPECT_EQ(result["in_short"], "Disagrees: \"fire is cold\".");
    EXPECT_EQ(result["remark"], "More.");
    EXPECT_EQ(result["paper"], Json({{"printed", 7}, {"says", {"water is wet", "fire is cold"}}}));
    EXPECT_EQ(result["values"]["a"], 1);
}

TEST(Findings, ListUntestableClaimsSeparately) {
    Findings findings;
    EXPECT_EQ(findings.result(nullptr)["verdict"], "left open by the paper");
    EXPECT_EQ(findings.result(nullptr)["note"], "The paper leaves this open.");
    findings.add_untestable("red is 195", false, "it is 12");
    const Json nothing_tested = findings.result(nullptr);
    EXPECT_EQ(nothing_tested["verdict"], "cannot be tested here");
    EXPECT_EQ(nothing_tested["note"], "Cannot be tested here; what stands in does not show it.");
    EXPECT_TRUE(nothing_tested["agrees"].is_null());
    EXPECT_EQ(nothing_tested["checks"][0], Json({{"says", "red is 195"},
                                                 {"verdict", "cannot be tested here"},
                                                 {"measured", "It does not hold here: it is 12"}}));
    findings.add("water is wet", true, "it is");
    const Json tested = findings.result(nullptr);
    EXPECT_EQ(tested["verdict"], "agrees");
    EXPECT_EQ(tested["note"], "Agrees: 1 of 2 statements hold, the others cannot be tested here.");
    EXPECT_EQ(tested["checks"][1]["verdict"], "agrees");
    findings.make_untestable();
    EXPECT_EQ(findings.result(nullptr)["note"],
              "Cannot be tested here; what stands in shows 1 of 2 statements.");
}

TEST(Findings, KeepClaimsOfOursApartFromThePapers) {
    Findings findings;
    findings.add("water is wet", true, "it is");
    findings.add_own("ice is dry", false, "it melts");
    const Json result = findings.result(nullptr);
    EXPECT_EQ(result["agrees"], true);
    EXPECT_EQ(result["paper"]["says"], Json({"water is wet"}));
    EXPECT_EQ(result["own"],
              Json({{{"claim", "ice is dry"}, {"holds", false}, {"measured", "it melts"}}}));
    EXPECT_EQ(result["note"], "Agrees. Ours does not hold, \"ice is dry\": it melts.");
}

TEST(Findings, AreCountedInOneLine) {
    Findings good, bad, open;
    good.add("a", true, "");
    good.add_untestable("b", true, "");
    bad.add("c", false, "");
    EXPECT_EQ(count_verdicts({{"one", good.result(nullptr)}}),
              "Of 1 item of the paper, 1 agrees. Of 2 statements, 1 agrees, 1 cannot be tested "
              "here.");
    EXPECT_EQ(count_verdicts({{"one", good.result(nullptr)},
                              {"two", bad.result(nullptr)},
                              {"three", bad.result(nullptr)},
                              {"four", open.result(nullptr)}}),
              "Of 4 items of the paper, 1 agrees, 2 disagree, 1 is left open by it. Of 4 "
              "statements, 1 agrees, 2 disagree, 1 cannot be tested here.");
}

// Draws all items but `order` and `dithering`, which take long (tests/cli/reproduce_test.cpp), and
// items that draw (lamar_drawn_test.cpp).
TEST(Lamar, EveryItemHasItsKeysAndWritesItsFiles) {
    for (const LamarItem& item : lamar_items()) {
        ASSERT_NE(item.reproduce == nullptr, item.draw == nullptr) << item.name;
        if (item.draw != nullptr || item.name == "order" || item.name == "dithering") continue;
        const TemporaryFolder folder;
        const Json result = item.reproduce(folder.path());
        for (const char* key : {"values", "paper", "verdict", "agrees", "note", "checks", "own"}) {
            EXPECT_TRUE(result.contains(key)) << item.name << " " << key;
        }
        // A figure has a caption.
        EXPECT_EQ(result["values"].contains("panels"), result["values"].contains("caption"))
            << item.name;
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
    EXPECT_EQ(table["agrees"], false);
    ASSERT_EQ(table["checks"].size(), 2u);
    EXPECT_EQ(table["checks"][0]["verdict"], "agrees");
    EXPECT_EQ(table["checks"][1]["verdict"], "disagrees");
    EXPECT_TRUE(table["checks"][1]["says"].get<std::string>().starts_with("Column (d) shows"));
    std::vector<int> buffer;
    for (const Json& row : table["values"]["rows"]) buffer.push_back(row["buffer"]);
    // docs/numerics.md, "Where the papers are wrong".
    EXPECT_EQ(buffer, (std::vector<int>{0, 0, 64, 64, 96, 136, 183, 220, 255}));
    EXPECT_EQ(table["values"]["rows"][4]["c"], ".00000010 11000001");
    EXPECT_EQ(table["values"]["rows"][4]["d"], "0.3946590");
}

TEST(Lamar, Table2AgreesWithThePaper) {
    const TemporaryFolder folder;
    const Json table = reproduce_table2(folder.path());
    EXPECT_EQ(table["agrees"], true);
    const Json& rows = table["values"]["rows"];
    ASSERT_EQ(rows.size(), 16u);
    for (std::size_t f = 0; f < 16; ++f)
        EXPECT_EQ(rows[0][std::string("f").append(std::to_string(f))], f);
    EXPECT_EQ(rows[8]["b"], 8);
    EXPECT_EQ(rows[8]["f1"], 8);  // the paper's example: [8,1] => 8
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

TEST(Lamar, FusedCurvesOfFigure3NeverDecrease) {
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
