// SPDX-License-Identifier: Apache-2.0
// lamina study: mistakes in the input are reported in one line before anything is drawn.
#include <gtest/gtest.h>

#include <algorithm>

#include "cli/study_test_case.h"

namespace lamina {
namespace {

using nlohmann::json;

class StudyMistakes : public StudyTestCase {
  protected:
    void expect_refused(const std::vector<std::string>& parts, int exit_code = 1,
                        const std::vector<std::string>& options = {}) {
        const ProgramResult result = run("out", options);
        EXPECT_EQ(result.exit_code, exit_code) << result.err;
        EXPECT_EQ(result.out, "");
        EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
        for (const std::string& part : parts)
            EXPECT_NE(result.err.find(part), std::string::npos) << part << ": " << result.err;
        EXPECT_FALSE(std::filesystem::exists(folder / "out"));
    }
    void expect_bad(const char* key, const json& value, std::vector<std::string> parts) {
        const json kept = study;
        // Without the sweep or the scenes that they name, rules of `drop` would be mistakes, too.
        if (key == std::string("sweep") || key == std::string("scenes")) study.erase("drop");
        study[key] = value;
        parts.emplace_back("study.json");
        expect_refused(parts);
        study = kept;
    }
};

TEST_F(StudyMistakes, UnknownKeysAreNamedWithASuggestion) {
    expect_bad("sweep", {{"render.slice.sampels", {8, 16}}},
               {"render.slice.sampels", "unknown key", "did you mean \"samples\""});
    expect_bad("sweep", {{"rendr.target", "fixed8"}}, {"rendr", "did you mean \"render\""});
    expect_bad("base", {{"render.slise.samples", 8}}, {"render.slise", "\"slice\""});
    expect_bad("rounnds", 3, {"rounnds", "did you mean \"rounds\""});
    expect_bad("scenes", {{{"scene", "blobs.json"}, {"nam", "b"}}}, {"scenes.0.nam", "\"name\""});
    expect_bad("scenes", {{{"scene", "blobs.json"}, {"set", {{"imgae.width", 8}}}}},
               {"imgae", "\"image\""});
    expect_bad("drop", {{{"where", {{"scene", "ramp"}}}, {"becuse", "x"}, {"because", "x"}}},
               {"drop.0.becuse", "\"because\""});
}

TEST_F(StudyMistakes, KeysThatDoNotExistAreErrors) {
    for (const char* key : {"", ".", "render.", "render..target"})
        expect_bad("sweep", {{key, {1, 2}}}, {"sweep", std::string(key) + ": not a key"});
    expect_bad("sweep", {{"image.width.x", {1, 2}}, {"image.width", 8}},
               {"sweep", "image.width.x"});
    expect_bad("sweep", {{"transfer_function.points.7.value", {1, 2}}}, {"points.7.value"});
}

TEST_F(StudyMistakes, KeysWithTooManyPartsAreErrors) {
    std::string parts = "a";
    for (int i = 0; i < 100'000; ++i) parts += ".a";
    for (const std::string& key : {parts, std::string(200'000, '.')}) {
        expect_bad("sweep", {{key, {1, 2}}}, {"...: not a key of a scene", "at most 64 parts"});
        expect_bad("base", {{key, 1}}, {"...: not a key of a scene", "at most 64 parts"});
    }
}

TEST_F(StudyMistakes, AnEmptySweepIsAnError) {
    expect_bad("sweep", json::object(), {"sweep", "{}"});
    expect_bad("sweep", json::array(), {"sweep", "[]"});
    expect_bad("sweep", {{"render.target", json::array()}}, {"sweep.render.target", "[]"});
    study.erase("sweep");
    expect_refused({"study.json", "sweep", "is missing"});
}

TEST_F(StudyMistakes, ManyRunsNeedConsent) {
    json hundred = json::array(), thousand = json::array();
    for (int i = 1; i <= 1000; ++i) {
        if (i <= 100) hundred.push_back(i);
        thousand.push_back(i);
    }
    study["scenes"] = {"blobs.json"};
    study["drop"] = json::array();
    study["sweep"] = {
        {"image.width", hundred}, {"image.height", hundred}, {"render.slice.samples", thousand}};
    expect_refused({"study.json", "sweep", "10000000 runs", "--yes"});
    expect_refused({"study.json", "sweep", "10000000 runs", "100000"}, 1, {"--yes"});
    hundred.push_back(101);
    study["sweep"] = {{"image.width", hundred}, {"image.x", hundred}};
    expect_refused({"10201 runs", "--yes"});
    // --yes accepts the number of runs, and the next mistake is found.
    expect_refused({"image.x", "unknown key"}, 1, {"--yes"});
}

TEST_F(StudyMistakes, MissingFilesAreNamed) {
    expect_bad("scenes", {"blobs.json", "absent.json"},
               {"scenes.1", "absent.json", "no such file"});
    expect_bad("scenes", json::array(), {"scenes", "[]"});
    expect_bad("scenes", {5}, {"scenes.0", "5"});
    expect_bad("scenes", "blobs.json", {"scenes", "a list"});
    blobs["volume"] = "absent.nrrd";
    expect_refused({"study.json", "\"blobs\"", "absent.nrrd", "no such file"});
    blobs["volume"] = {{"generate", "gaussians"}, {"size", {16, 16, 16}}};
    blobs["mesh"] = "absent.vtu";
    expect_refused({"study.json", "\"blobs\"", "absent.vtu", "no such file"});
    blobs["mesh"] = {{"tolerance", 0.1}};
    blobs["transfer_function"] = {{"colormap", "absent.json"}};
    expect_refused({"study.json", "absent.json", "no such file"});
    std::filesystem::remove(folder / "study.json");
    EXPECT_EQ(lamina_run({"study", folder / "absent-study.json", "-o", folder / "out"}).exit_code,
              1);
    EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

TEST_F(StudyMistakes, ABaselineOfNotOneRunIsAnError) {
    expect_bad("baseline", {{"render.target", "float32"}},
               {"baseline", "found 2 runs", "\"blobs\"", "slice, float32", "project, float32"});
    expect_bad("baseline", {{"render.target", "fixed16"}}, {"baseline", "no run", "\"ramp\""});
    expect_bad("baseline", {{"render.method", "project"}, {"render.target", "fixed8"}},
               {"baseline", "no run", "\"ramp\""});
    expect_bad("baseline", {{"render.slice.samples", 8}},
               {"baseline", "render.slice.samples", "not swept"});
    expect_bad("baseline", "first", {"baseline", "\"first\""});
}

TEST_F(StudyMistakes, DroppingAllRunsOfASceneIsAnError) {
    expect_bad("drop",
               {{{"where", {{"render.target", {"float32", "fixed8"}}}}, {"because", "all"}}},
               {"drop", "no run", "\"ramp\""});
    expect_bad("drop", {{{"where", {{"scene", "blobs"}}}, {"because", "all of one"}}},
               {"drop", "no run", "\"blobs\""});
    expect_bad("drop", {{{"where", {{"render.slice.samples", 8}}}, {"because", "x"}}},
               {"drop.0.where", "render.slice.samples", "not swept"});
    expect_bad("drop", {{{"where", {{"render.target", "fixde8"}}}, {"because", "x"}}},
               {"drop.0.where", "no run has these values"});
    expect_bad("drop", {{{"where", json::object()}, {"because", "x"}}}, {"drop.0.where"});
    expect_bad("drop", {{{"where", {{"scene", "ramp"}}}}}, {"drop.0.because", "is missing"});
}

TEST_F(StudyMistakes, ScenesMustHaveDifferentNames) {
    expect_bad("scenes", {"blobs.json", "ramp.json", "blobs.json"}, {"scenes", "\"blobs\""});
    expect_bad("scenes", {"ramp.json", {{"scene", "blobs.json"}, {"name", "ramp"}}},
               {"scenes", "\"ramp\""});
}

TEST_F(StudyMistakes, UnknownContextsAreErrors) {
    expect_bad("base", {{"context", "directx"}}, {"context", "\"directx\"", "osmesa"});
    expect_bad("base", {{"context", 5}}, {"context", "\"5\"", "osmesa"});
    expect_bad("sweep", {{"context", {"cpu", "gpu"}}}, {"context", "\"gpu\"", "osmesa"});
}

TEST_F(StudyMistakes, InvalidValuesAreErrors) {
    expect_bad("version", 2, {"version", "2"});
    expect_bad("rounds", 0, {"rounds", "0", "from 1"});
    expect_bad("frames", 2.5, {"frames", "2.5"});
    expect_bad("title", 5, {"title", "5"});
    expect_bad("base", {1}, {"base", "[1]"});
    expect_bad("reference", "picture", {"reference", "\"picture\"", "\"mesh\""});
    // No run of a scene can have this value.
    expect_bad("sweep", {{"render.target", "fixed7"}, {"render.method", {"slice", "project"}}},
               {"no run can be drawn", "render.target", "\"fixed7\""});
}

TEST_F(StudyMistakes, FilesThatAreNotJsonObjectsAreErrors) {
    command("out");
    for (const char* text : {"", "{\"version\": 1,", "lamina", "[1, 2]", "{\"a\": 1, \"a\": 2}"}) {
        write_bytes_to(folder / "study.json", text);
        const ProgramResult result =
            lamina_run({"study", folder / "study.json", "-o", folder / "out"});
        EXPECT_EQ(result.exit_code, 1) << text;
        EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
        EXPECT_NE(result.err.find("study.json"), std::string::npos) << result.err;
    }
    blobs = json::array();
    expect_bad("title", "a scene that is a list", {"blobs.json"});
    EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

TEST_F(StudyMistakes, MistakesOfUsageExitWith2) {
    for (const char* shard : {"3/2", "0/2", "1/0", "1", "1/", "/2", "a/b", "1/2x", "1 /2", "-1/2",
                              "1/99999999999", "", "1/2/3", "1.5/2"})
        expect_refused({"--shard"}, 2, {std::string("--shard=") + shard});
    expect_refused({"--nonsense"}, 2, {"--nonsense"});
    write_files();
    EXPECT_EQ(lamina_run({"study", folder / "study.json"}).exit_code, 2);
    EXPECT_EQ(lamina_run({"study", "-o", folder / "out"}).exit_code, 2);
    EXPECT_FALSE(std::filesystem::exists(folder / "out"));
    const ProgramResult help = lamina_run({"study", "--help"});
    EXPECT_EQ(help.exit_code, 0);
    for (const char* word : {"--shard", "--resume", "--merge", "--yes"})
        EXPECT_NE(help.out.find(word), std::string::npos) << word;
}

TEST_F(StudyMistakes, AFolderThatCannotBeMadeIsAnError) {
    write_bytes_to(folder / "file", "");
    const ProgramResult result = run("file/out");
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_NE(result.err.find("cannot make this folder"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace lamina
