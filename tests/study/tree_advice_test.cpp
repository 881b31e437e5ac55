// SPDX-License-Identifier: Apache-2.0
#include "study/tree_advice.h"

#include <gtest/gtest.h>

#include "study/study_output.h"

namespace lamina::study {
namespace {

using Json = nlohmann::ordered_json;

// A study of one scene, with its first run as the baseline.
struct MadeUpStudy {
    StudyResults results;

    MadeUpStudy() {
        results.list.title = "trees";
        results.list.scenes = {"ramp"};
        results.list.own = {{}};
        results.list.swept = {"render.target", factors_key};
        results.list.baselines = {0};
        results.environment = {{"machine", "one"}};
    }
    // Adds a run; without factors it has no tree.
    RunResult& add(const char* target, const std::vector<int>& factors, double l2, double ratio) {
        StudyRun run;
        run.settings = {{"render.target", target}};
        if (!factors.empty()) run.settings.emplace_back(factors_key, factors);
        run.name = run_name(run.settings);
        run.id = std::to_string(results.list.runs.size());
        results.list.runs.push_back(run);
        RunResult result;
        result.run = results.runs.size();
        result.all.l2 = l2;
        result.all.linf = 3 * l2;
        result.ratio = ratio;
        result.pareto = true;
        result.frame_ms = result.still_ms = {10 * ratio};
        results.runs.push_back(result);
        return results.runs.back();
    }
    std::vector<const RunResult*> runs() const {
        std::vector<const RunResult*> pointers;
        for (const RunResult& run : results.runs) pointers.push_back(&run);
        return pointers;
    }
};

MadeUpStudy trees_of_two_targets() {
    MadeUpStudy study;
    study.add("float32", {}, 0.001, 1);
    study.add("fixed8", {}, 40, 1.5);
    study.add("fixed8", {1024}, 0.5, 0.9);        // 1 node
    study.add("fixed8", {8, 128}, 0.25, 1.1);     // 9 nodes
    study.add("fixed8", {2, 512}, 0.75, 1);       // 3 nodes
    study.add("fixed8", {32, 32}, 0.4, 1.2);      // 33 nodes
    study.add("fixed8", {4, 4, 64}, 0.3, 1.4);    // 21 nodes
    study.add("float32", {32, 32}, 0.0005, 1.3);  // 33 nodes
    return study;
}

TEST(TreeAdvice, CountsTheImagesOfATree) {
    EXPECT_EQ(nodes_of({1024}), 1);
    EXPECT_EQ(nodes_of({32, 32}), 33);
    EXPECT_EQ(nodes_of({8, 128}), 9);
    EXPECT_EQ(nodes_of({8, 8, 16}), 1 + 8 + 64);
    EXPECT_EQ(nodes_of({}), 0);
}

TEST(TreeAdvice, TakesTheSmallestErrorAtEachNumberOfNodes) {
    const MadeUpStudy study = trees_of_two_targets();
    const std::vector<TreeGroup> groups = tree_groups(study.results.list, study.runs());
    ASSERT_EQ(groups.size(), 2u);
    EXPECT_EQ(groups[0].name, "fixed8");
    EXPECT_FALSE(groups[0].in_floats);
    ASSERT_EQ(groups[0].choices.size(), 3u);
    const std::pair<std::int64_t, std::size_t> wanted[] = {{1, 2}, {10, 3}, {100, 6}};
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(groups[0].choices[i].most_nodes, wanted[i].first);
        EXPECT_EQ(groups[0].choices[i].run->run, wanted[i].second);
    }
    EXPECT_EQ(groups[0].best().run, 3u);
    ASSERT_NE(groups[0].straight, nullptr);
    EXPECT_EQ(groups[0].straight->run, 1u);
    // Trees in floats are a group of their own, which is the last.
    EXPECT_EQ(groups[1].name, "float32");
    EXPECT_TRUE(groups[1].in_floats);
    EXPECT_EQ(groups[1].best().run, 7u);
}

TEST(TreeAdvice, SaysWhatToTakeWhatItCostsAndWhatItGains) {
    const MadeUpStudy study = trees_of_two_targets();
    EXPECT_EQ(tree_findings(study.results.list, "ramp", study.runs(), false),
              (std::vector<std::string>{
                  "ramp, fixed8: take the factors 8x128 (9 nodes): L2 0.25, 160 times less than "
                  "without a tree, in 1.10 times the time of float32."}));
    EXPECT_EQ(tree_findings(study.results.list, "ramp", study.runs(), true),
              (std::vector<std::string>{
                  "ramp, float32: take the factors 32x32 (33 nodes): L2 0.0005, 2 times less than "
                  "without a tree, in 1.30 times the time of float32."}));
}

TEST(TreeAdvice, SaysWhenATreeGainsNothing) {
    MadeUpStudy study;
    study.add("fixed8", {}, 0.25, 1);
    study.add("fixed8", {4}, 0.5, 2);
    const auto said = [&] {
        return tree_findings(study.results.list, "ramp", study.runs(), false).at(0);
    };
    EXPECT_EQ(said(),
              "ramp, fixed8: take the factors 4 (1 node): L2 0.5, but 0.25 without a tree, in 2.00 "
              "times the time of fixed8.");
    for (RunResult& run : study.results.runs) run.reference_error = 1;
    EXPECT_EQ(said(),
              "ramp, fixed8: take the factors 4 (1 node): L2 0.5, which the reference's own error "
              "does not tell from that without a tree, in 2.00 times the time of fixed8.");
}

// Failed runs are left out, and the report has the tables first.
TEST(TreeAdvice, IsTheAnswerOfTheReport) {
    MadeUpStudy study = trees_of_two_targets();
    study.add("fixed8", {256, 4}, 0, 1).failed = "no memory";
    const Json report = report_of(study.results);
    EXPECT_TRUE(report["findings"][0].get<std::string>().starts_with("ramp, fixed8: take"));
    const Json& tables = report["answers"]["tables"];
    ASSERT_EQ(tables.size(), 3u);
    std::vector<std::string> taken, nodes;
    for (const Json& row : tables[0]["rows"]) {
        taken.push_back(row["take"]);
        nodes.push_back(row["nodes"]);
    }
    EXPECT_EQ(taken, (std::vector<std::string>{"1024", "8x128", "4x4x64"}));
    EXPECT_EQ(nodes, (std::vector<std::string>{"1", "2 to 10", "11 to 100"}));
    EXPECT_EQ(tables[0]["rows"][1]["L2 without a tree / its L2"], 160);
    EXPECT_EQ(tables[0]["rows"][1]["× baseline"], 1.1);
    // Trees in floats have their own table: their target alone would make them best.
    ASSERT_EQ(tables[1]["rows"].size(), 1u);
    EXPECT_EQ(tables[1]["rows"][0]["take"], "32x32");
    ASSERT_EQ(tables[2]["rows"].size(), 2u);
    EXPECT_EQ(tables[2]["rows"][0]["drawn with"], "fixed8");
    EXPECT_EQ(tables[2]["rows"][1]["drawn with"], "float32");
}

TEST(TreeAdvice, IsNotGivenWithoutTrees) {
    MadeUpStudy study;
    study.add("float32", {}, 0.25, 1);
    EXPECT_TRUE(tree_answers(study.results).is_null());
    EXPECT_FALSE(report_of(study.results).contains("answers"));
}

}  // namespace
}  // namespace lamina::study
