// SPDX-License-Identifier: Apache-2.0
#include "study/study_runner.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace lamina::study {
namespace {

using nlohmann::json;

class RunLists : public testing::Test {
  protected:
    void SetUp() override {
        scene = json::parse(R"({
            "version": 1,
            "volume": {"generate": "gaussians", "size": [8, 8, 8]},
            "mesh": {"tolerance": 0.1},
            "transfer_function": {"points": [{"value": 0, "color": [1, 1, 1], "extinction": 0},
                                             {"value": 255, "color": [1, 1, 1], "extinction": 8}]},
            "camera": {"eye": [1.7, -0.9, 1.3], "center": [0.5, 0.5, 0.5]},
            "image": {"width": 8, "height": 8},
            "render": {"slice": {"samples": 16}}})");
        study = {{"version", 1},
                 {"scenes", {"a.json", "b.json"}},
                 {"sweep",
                  {{"render.target", {"fixed8", "float32"}},
                   {"render.slice.samples", {8, 16, nullptr}}}}};
    }

    StudyFile load() {
        for (const char* name : {"a.json", "b.json"}) write_bytes_to(folder / name, scene.dump());
        write_bytes_to(folder / "study.json", study.dump());
        return load_study(folder / "study.json");
    }
    RunList list() { return list_runs(load()); }

    static std::set<std::string> ids_of(const RunList& list) {
        std::set<std::string> ids;
        for (const StudyRun& run : list.runs) ids.insert(run.id);
        return ids;
    }

    TemporaryFolder folder;
    json scene, study;
};

TEST_F(RunLists, EveryRunHasAnIdOfItsOwnThatStays) {
    const RunList first = list(), second = list();
    ASSERT_EQ(first.runs.size(), 12u);  // 2 scenes, 2 targets, 3 samples
    EXPECT_EQ(ids_of(first).size(), 12u);
    for (std::size_t i = 0; i < 12; ++i) {
        EXPECT_EQ(first.runs[i].id, second.runs[i].id);
        EXPECT_EQ(first.runs[i].scene, i / 6);
        EXPECT_FALSE(first.runs[i].name.empty());
    }
    EXPECT_EQ(first.id(), second.id());
    EXPECT_EQ(first.swept, (std::vector<std::string>{"render.slice.samples", "render.target"}));
    EXPECT_EQ(first.baselines, (std::vector<std::size_t>{0, 6}));
    EXPECT_TRUE(first.dropped.empty());
}

TEST_F(RunLists, IdsChangeWithEverythingThatIsMeasured) {
    const RunList before = list();
    const auto expect_other_ids = [&](const char* what) {
        const RunList after = list();
        EXPECT_NE(after.id(), before.id()) << what;
        for (const std::string& id : ids_of(after))
            EXPECT_FALSE(ids_of(before).contains(id)) << what;
    };
    const json kept = study, kept_scene = scene;
    study["base"]["context"] = "osmesa";
    expect_other_ids("context");
    study = kept;
    study["base"]["image.width"] = 9;
    expect_other_ids("base");
    study = kept;
    study["reference"] = "mesh";
    expect_other_ids("reference");
    study = kept;
    scene["camera"]["eye"][0] = 1.75;
    expect_other_ids("the scene's file");
    scene = kept_scene;
    study["rounds"] = 4;  // the runs are the same, the study is another one
    EXPECT_EQ(ids_of(list()), ids_of(before));
    EXPECT_NE(list().id(), before.id());
    study = kept;
    study["title"] = "says nothing of the runs";
    EXPECT_EQ(list().id(), before.id());
}

TEST_F(RunLists, AreReadAsTheyWereWritten) {
    study["drop"] = {{{"where", {{"render.target", "fixed8"}, {"scene", "a"}}}, {"because", "x"}}};
    RunList made = list();
    made.data = {{"a.nrrd", "0123456789abcdef"}, {"cannot be read", ""}};
    const RunList read = run_list_from(json::parse(to_json(made).dump()), "runs.json");
    EXPECT_EQ(read.id(), made.id());
    EXPECT_EQ(to_json(read), to_json(made));
    json other = json::parse(to_json(made).dump());
    other["runs"].erase(other["runs"].size() - 1);
    expect_error([&] { run_list_from(other, "runs.json"); }, {"runs.json", "lamina study"});
    other = json::parse(to_json(made).dump());
    other.erase("rounds");
    expect_error([&] { run_list_from(other, "runs.json"); }, {"runs.json", "rounds"});
    other = json::parse(to_json(made).dump());
    other.erase("data");
    expect_error([&] { run_list_from(other, "runs.json"); }, {"runs.json", "older lamina"});
}

TEST_F(RunLists, ListsOfDifferentDataDoNotMatch) {
    const auto list_of = [](const std::vector<std::string>& contents) {
        RunList made;
        for (const std::string& content : contents) made.data.push_back({"a.nrrd", content});
        return made;
    };
    RunList now = list_of({"1", "", "3"});
    match_data(now, "now", list_of({"1", "2", ""}),
               "runs.json");  // unreadable contents match any
    EXPECT_EQ(to_json(now)["data"], to_json(list_of({"1", "2", "3"}))["data"]);
    expect_error(
        [&] {
            match_data(now, "now", list_of({"1", "2", "4"}), "runs.json");
        },
        {"a.nrrd: found", "hash 3 (now)", "expected 4 (runs.json)"});
    expect_error([&] { match_data(now, "now", list_of({"1"}), "runs.json"); }, {"3 data sets"});
}

TEST_F(RunLists, EqualRunsAreDroppedAndReported) {
    study["sweep"] = {{{"render.slice.samples", {8, 16, 8}}},
                      {{"render.slice.samples", {16, 32}}},
                      {{"render.target", {"float32", "fixed8"}}, {"render.slice.samples", 8}}};
    const RunList made = list();
    // For each scene: 8, 16, (8), (16), 32, float32 8, fixed8 8. The list does not know that a run
    // without a target is drawn in float32.
    EXPECT_EQ(made.runs.size(), 2u * 5);
    ASSERT_EQ(made.dropped.size(), 1u);
    EXPECT_EQ(made.dropped[0].runs, 2u * 2);
    EXPECT_NE(made.dropped[0].because.find("same"), std::string::npos);
}

TEST_F(RunLists, NullRemovesAKey) {
    const StudyFile file = load();
    const RunList made = list_runs(file);
    int without = 0;
    for (const StudyRun& run : made.runs) {
        const json document = document_of(run, file);
        const json* const samples = find_setting(run.settings, "render.slice.samples");
        ASSERT_NE(samples, nullptr);
        EXPECT_EQ(document["render"]["slice"].contains("samples"), !samples->is_null());
        EXPECT_EQ(document["render"]["target"], *find_setting(run.settings, "render.target"));
        without += samples->is_null() ? 1 : 0;
    }
    EXPECT_EQ(without, 4);
    check_runs(made, file);  // throws if a run cannot be read

    // If the scene lacks the key, null leaves it out, and the run is that of the scene.
    study["sweep"] = {{"render.slice.tree.factors", {nullptr, {4, 4}}}};
    const StudyFile other = load();
    const RunList trees = list_runs(other);
    EXPECT_EQ(document_of(trees.runs[0], other), scene);
    EXPECT_EQ(trees.runs[0].name, "as the scene");
}

TEST_F(RunLists, ASceneOverridesTheBase) {
    study["base"] = {{"image.width", 5}, {"image.height", 6}};
    study["scenes"] = {"a.json",
                       {{"scene", "b.json"}, {"name", "c"}, {"set", {{"image.width", 7}}}}};
    study["sweep"] = {{"render.slice.samples", 8}};
    const StudyFile file = load();
    const RunList made = list_runs(file);
    EXPECT_EQ(made.scenes, (std::vector<std::string>{"a", "c"}));
    EXPECT_EQ(document_of(made.runs[0], file)["image"], json({{"width", 5}, {"height", 6}}));
    EXPECT_EQ(document_of(made.runs[1], file)["image"], json({{"width", 7}, {"height", 6}}));
}

TEST_F(RunLists, ContextIsNoKeyOfTheScene) {
    study["base"] = {{"context", "osmesa"}};
    study["sweep"] = {{"context", {"cpu", nullptr}}, {"render.slice.samples", {8, 16}}};
    const StudyFile file = load();
    const RunList made = list_runs(file);
    std::multiset<std::string> contexts;
    for (const StudyRun& run : made.runs) {
        contexts.insert(context_of(run, file));
        EXPECT_FALSE(document_of(run, file).contains("context"));
    }
    EXPECT_EQ(contexts.count("cpu"), 4u);
    EXPECT_EQ(contexts.count("osmesa"), 4u);  // null takes the context of `base`
}

TEST_F(RunLists, DropRulesAreCounted) {
    study["drop"] = {
        {{"where", {{"scene", "a"}, {"render.target", "fixed8"}}}, {"because", "first"}},
        {{"where", {{"render.slice.samples", {16, nullptr}}}}, {"because", "second"}}};
    const RunList made = list();
    // Scene a keeps float32 with 8; scene b keeps fixed8 and float32 with 8.
    EXPECT_EQ(made.runs.size(), 3u);
    ASSERT_EQ(made.dropped.size(), 2u);
    EXPECT_EQ(made.dropped[0].because, "first");
    EXPECT_EQ(made.dropped[0].runs, 3u);
    EXPECT_EQ(made.dropped[1].because, "second");
    // Runs that several rules match count for the first one.
    EXPECT_EQ(made.dropped[1].runs, 2u + 4);
    for (const StudyRun& run : made.runs)
        EXPECT_EQ(*find_setting(run.settings, "render.slice.samples"), 8);
}

TEST_F(RunLists, DropRulesThatMatchNothingAreMistakes) {
    study["drop"] = {{{"where", {{"scene", "nowhere"}}}, {"because", "never"}}};
    expect_error([&] { list(); }, {"study.json", "drop.0.where", "no run has these values"});
}

TEST_F(RunLists, DropRulesAreLimitedInNumber) {
    study["drop"] =
        std::vector<json>(1001, {{"where", {{"render.target", "fixed8"}}}, {"because", "again"}});
    expect_error([&] { list(); }, {"study.json", "drop", "1001 rules", "at most 1000"});
}

TEST_F(RunLists, HaveOneBaselineOfEachScene) {
    study["baseline"] = {{"render.target", "float32"}, {"render.slice.samples", nullptr}};
    const RunList made = list();
    ASSERT_EQ(made.baselines.size(), 2u);
    for (std::size_t scene_number = 0; scene_number < 2; ++scene_number) {
        const StudyRun& run = made.runs[made.baselines[scene_number]];
        EXPECT_EQ(run.scene, scene_number);
        EXPECT_EQ(*find_setting(run.settings, "render.target"), "float32");
        EXPECT_TRUE(find_setting(run.settings, "render.slice.samples")->is_null());
    }
}

TEST_F(RunLists, AreCountedBeforeTheyAreMade) {
    EXPECT_EQ(run_count(load()), 12u);
    json values = json::array();
    for (int i = 1; i <= 1000; ++i) values.push_back(i);
    study["sweep"] = {
        {"image.width", values}, {"image.height", values}, {"render.slice.samples", values}};
    const StudyFile file = load();
    EXPECT_EQ(run_count(file), 2'000'000'000u);
    expect_error([&] { list_runs(file); }, {"study.json", "sweep", "2000000000", "100000"});
    for (int i = 0; i < 5; ++i)
        study["sweep"]["transfer_function.points.0.k" + std::to_string(i)] = values;
    EXPECT_EQ(run_count(load()), std::uint64_t{(1ull << 63) - 1});  // 2 * 10^24 saturates
}

}  // namespace
}  // namespace lamina::study
