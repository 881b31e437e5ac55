// SPDX-License-Identifier: Apache-2.0
// Words of the command line for what people change of a picture: --up, --view, --light, --clip, ...
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "cli/blobs_scene.h"
#include "cli/lamina_run.h"
#include "image/exr.h"
#include "image/png.h"
#include "lamina/scene.h"
#include "support/temporary_folder.h"

namespace lamina {
namespace {

using nlohmann::json;

class WordsRun : public ::testing::Test {
  protected:
    void SetUp() override {
        const ProgramResult made = lamina_run({"generate", "gaussians", "-o", folder / "v.nrrd",
                                               "--type", "uint8", "--size", "16,16,16"});
        ASSERT_EQ(made.exit_code, 0) << made.err;
    }

    ProgramResult run(const std::vector<std::string>& more, const char* verb = "scene",
                      const std::string& output = "-") {
        std::vector<std::string> arguments{verb,   folder / "v.nrrd", "-o",
                                           output, "--size",          "40x30"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return lamina_run(arguments);
    }
    // Returns the scene that lamina would draw with these options.
    json scene(const std::vector<std::string>& more) {
        const ProgramResult result = run(more);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return json::parse(result.out.empty() ? "{}" : result.out);
    }

    TemporaryFolder folder;
};

// Each word stands for keys of the scene, to the last bit.
TEST_F(WordsRun, StandForKeysOfTheScene) {
    const std::vector<std::pair<std::vector<std::string>, std::vector<std::string>>> same{
        {{"--light"}, {"--set", "lighting=true"}},
        {{"--light", "headlight"}, {"--set", "lighting={}"}},
        {{"--clip", "x>.5", "--clip", "y::.75"}, {"--clip", "x:.5:", "--clip", "y<.75"}},
        {{"--view", "iso", "--up", "+y"}, {}}};
    for (const auto& [word, keys] : same)
        EXPECT_EQ(scene(word), scene(keys)) << word[0] << " " << word.back();
    // A clip leaves the automatic choice of colours as it is.
    json cut = scene({"--crop", "0:.5,.25:1,0:1"});
    EXPECT_EQ(cut["clip"], json::parse(R"({"box": {"min": [0, 0.25, 0], "max": [0.5, 1, 1]}})"));
    const json planes = scene({"--clip", "z:.25:"})["clip"]["planes"];
    EXPECT_EQ(planes, json::parse(R"([{"point": [0, 0, 0.25], "normal": [0, 0, 1]}])"));
}

TEST_F(WordsRun, DrawThePictureOfTheSceneTheyWrite) {
    const std::vector<std::string> words{"--view",    "left",    "--up",      "+z",
                                         "--light",   "two",     "--clip",    "x<.6",
                                         "--opacity", "sigmoid", "--density", "2"};
    std::vector<std::string> drawn = words;
    drawn.insert(drawn.end(), {"--context", "cpu"});
    EXPECT_EQ(run(drawn, "render", folder / "a.exr").exit_code, 0);
    EXPECT_EQ(run(words, "scene", folder / "s.json").exit_code, 0);
    const ProgramResult again =
        lamina_run({"render", folder / "s.json", "-o", folder / "b.exr", "--context", "cpu"});
    EXPECT_EQ(again.exit_code, 0) << again.err;
    EXPECT_EQ(read_exr(std::string(folder / "a.exr")).rgba,
              read_exr(std::string(folder / "b.exr")).rgba);
    EXPECT_NE(read_bytes_of(folder / "a.exr").find("\"normal\""), std::string::npos);
}

TEST_F(WordsRun, WhatIsChosenIsSaid) {
    const std::string said = run({"--up", "-z", "--light", "left"}).err;
    EXPECT_NE(said.find("-z is up, as asked"), std::string::npos) << said;
    EXPECT_NE(said.find("lighting: left, as asked"), std::string::npos) << said;
    EXPECT_NE(run({}).err.find("y is up"), std::string::npos);
}

TEST_F(WordsRun, MistakesAreOfUsage) {
    const std::vector<std::pair<std::vector<std::string>, std::string>> mistakes{
        {{"--up", "z"}, "--up z: expected +x, -x, +y, -y, +z or -z"},
        {{"--view", "north"}, "--view north: expected iso, front, back"},
        {{"--light", "sun"}, "--light sun: expected headlight, left, right or two"},
        {{"--clip", "x"}, "--clip x: expected x:10:"},
        {{"--crop", "1:2"}, "--crop 1:2: expected x0:x1,y0:y1,z0:z1"},
        {{"--opacity", "cubic"}, "--opacity cubic: expected linear"},
        {{"--preset", "ct"}, "--preset ct: expected one of ct-bone"}};
    for (const auto& [mistake, message] : mistakes) {
        const ProgramResult result = run(mistake, "render", folder / "x.png");
        EXPECT_EQ(result.exit_code, 2) << result.err;
        EXPECT_NE(result.err.find(message), std::string::npos) << result.err;
        EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << result.err;
        EXPECT_FALSE(std::filesystem::exists(folder / "x.png"));
    }
    const ProgramResult units = run({"--preset", "ct-bone"}, "render", folder / "x.png");
    EXPECT_EQ(units.exit_code, 1);
    EXPECT_NE(units.err.find("v.nrrd: found values from"), std::string::npos) << units.err;
    EXPECT_NE(units.err.find("expected HU for ct-bone"), std::string::npos) << units.err;
}

// --light alone is a headlight, also before the file.
TEST_F(WordsRun, LightTakesNoFileForItsWord) {
    const ProgramResult before =
        lamina_run({"scene", "--light", folder / "v.nrrd", "-o", "-", "--size", "40x30"});
    ASSERT_EQ(before.exit_code, 0) << before.err;
    EXPECT_EQ(json::parse(before.out), scene({"--light"}));
    const ProgramResult absent = lamina_run({"scene", "--light", folder / "none.nrrd", "-o", "-"});
    EXPECT_EQ(absent.exit_code, 1);
    EXPECT_NE(absent.err.find("none.nrrd: no such file"), std::string::npos) << absent.err;
}

TEST_F(WordsRun, OptionsThatAreWrongAreNamed) {
    const auto expect = [&](const std::vector<std::string>& more, const std::string& message) {
        const ProgramResult result = run(more, "render", folder / "x.png");
        EXPECT_EQ(result.exit_code, 2);
        EXPECT_TRUE(result.err.starts_with("lamina: " + message)) << result.err;
        EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << result.err;
    };
    expect({"--size", "20x10"}, "--size: found 2 times, expected once");
    expect({"--colourmap", "greys"}, "--colourmap: no such option, did you mean \"--colormap\"?");
    expect({"--titel", "x"}, "--titel: no such option, did you mean \"--title\"?");
    expect({"--set", "mesh.scalar=p"}, "--set mesh.scalar: expected scalar=p: the array of a mesh");
    const ProgramResult no_mesh = run({"--method", "project"}, "render", folder / "x.png");
    EXPECT_NE(no_mesh.err.find("without a mesh (mesh.tolerance=.02 makes one of the volume)"),
              std::string::npos)
        << no_mesh.err;
    expect({"--max-error", ".1"},
           "--max-error: no such option, did you mean --set render.max_error=VALUE?");
    expect({"--set", "max_error=.1"},
           "--set max_error: unknown key, did you mean \"render.max_error\"?");
    EXPECT_TRUE(lamina_run({"scene", folder / "v.nrrd"})
                    .err.starts_with("lamina: scene: expected -o FILE: Scene file to write ("));
    EXPECT_TRUE(lamina_run({"compare", "a.png"})
                    .err.starts_with("lamina: compare: expected B: Picture to measure against"));
    expect({"--nothing-like-it"}, "--nothing-like-it: no such option (");
    expect({"-size", "20x10"},
           "-size: no such option, did you mean \"--size\"? (lamina render --help");
    expect({"w.nrrd"}, "w.nrrd: not expected here (lamina render --help shows");
    write_bytes_to(folder / "w.nrrd", "");
    expect({folder / "w.nrrd"},
           std::string(folder / "w.nrrd") +
               ": not expected here: lamina render takes one file at a time, as in for f in "
               "*.nrrd; do lamina render \"$f\" -o \"${f%.*}.png\"; done (");
    expect({"--set", "camera.fov_y", "20"},
           "--set camera.fov_y: expected KEY=VALUE, did you mean --set camera.fov_y=20?");
    expect({"--set", "camera.fov_y=20"}, "--set camera.fov_y: the camera of " +
                                             std::string(folder / "v.nrrd") +
                                             " is automatic, and one that is given needs its eye");
    expect({"--camera.fov_y", "20"},
           "--camera.fov_y: no such option, did you mean --set camera.fov_y=VALUE?");
    const ProgramResult bare = lamina_run({"render", folder / "v.nrrd", "x.png"});
    EXPECT_NE(bare.err.find("x.png: not expected here, did you mean -o x.png?"), std::string::npos);
    EXPECT_NE(lamina_run({"rendr"}).err.find("rendr: unknown verb, did you mean \"render\"?"),
              std::string::npos);
    EXPECT_EQ(lamina_run({"help", "render"}).out, lamina_run({"render", "--help"}).out);
    EXPECT_EQ(lamina_run({"help"}).out, lamina_run({"--help"}).out);
    EXPECT_NE(lamina_run({}).err.find("expected a verb, one of compare, "), std::string::npos);
    EXPECT_NE(lamina_run({"--hepl"}).err.find("--hepl: expected a verb, one of compare, "),
              std::string::npos);
    expect({"--zoom"}, "--zoom: expected a value after it");
    expect({"--zoom", "two"}, "--zoom: found two, expected a number (");
    expect({"--opacity", ""}, "--opacity: found '', expected a value (");
    expect({"--fps", "2.5"}, "--fps: found 2.5, expected a whole number from 1 to 240 (");
    expect({"--fps", "300"}, "--fps: found 300, expected a whole number from 1 to 240 (");
    expect({"--turn-by", "200"}, "--turn-by: found 200, expected a number from -180 to 180 (");
}

// An option in place of a value is no value, unless it is joined to its option.
TEST_F(WordsRun, AnOptionThatFollowsIsNoValue) {
    const auto expect = [&](const std::vector<std::string>& more, const std::string& message) {
        const ProgramResult result = run(more, "render", folder / "x.png");
        EXPECT_EQ(result.exit_code, 2);
        EXPECT_TRUE(result.err.starts_with("lamina: " + message)) << result.err;
        EXPECT_FALSE(std::filesystem::exists(folder / "x.png"));
        EXPECT_FALSE(std::filesystem::exists("--quiet"));
    };
    expect({"--title", "--legend"},
           "--title: found the option --legend, expected a value (--title=--legend if it is");
    expect({"--title", "-o"}, "--title: found the option -o, expected a value");
    expect({"--title", "--legnd"}, "--title: found the option --legnd, expected a value");
    expect({"--stats", "--quiet"}, "--stats: found the option --quiet, expected a value");
    expect({"--background", "--title", "T"}, "--background: found the option --title, expected");
    expect({"--set", "--quiet"}, "--set: found the option --quiet, expected a value");
    EXPECT_EQ(scene({"--title=--legend"})["image"]["annotations"]["title"], "--legend");
    EXPECT_EQ(scene({"--title", "--a title"})["image"]["annotations"]["title"], "--a title");
    EXPECT_EQ(scene({"--title", "-5 K"})["image"]["annotations"]["title"], "-5 K");
    EXPECT_EQ(scene({"--azimuth", "-30", "--up", "-x"}).count("camera"), 1u);
}

TEST_F(WordsRun, OutputsOfNoKnownKindSayWhichThereAre) {
    const auto expect = [&](const std::string& output, const std::string& message) {
        const ProgramResult result = lamina_run({"render", folder / "v.nrrd", "-o", output});
        EXPECT_EQ(result.exit_code, 2);
        EXPECT_NE(result.err.find(message), std::string::npos) << result.err;
    };
    expect(folder / "f.avi", ".png, .exr or .npy; films end in .mp4, .webm, .gif or .apng");
    expect(std::string(folder / ""), "is a folder, expected a file");
}

// A background is drawn or not; annotations suit it in any case.
TEST_F(WordsRun, TransparencyWinsOverABackgroundAndSaysSo) {
    const std::vector<std::string> words{"--transparent", "--background", "white", "--title", "T"};
    const ProgramResult drawn = run(words, "render", folder / "x.png");
    EXPECT_EQ(drawn.exit_code, 0);
    EXPECT_NE(drawn.err.find("--transparent: there is no background"), std::string::npos)
        << drawn.err;
    EXPECT_EQ(read_png(folder / "x.png").codes[3], 0);
}

// A scene that names a map in HU itself draws as it says, with the reason why that may be wrong.
TEST_F(WordsRun, AMapInHuOfASceneIsWarnedOfIfTheDataAreNotInHu) {
    const auto said = [&](const json& transfer_function, const std::vector<std::string>& more) {
        json document = {{"version", 1}, {"volume", "v.nrrd"}};
        document["transfer_function"] = transfer_function;
        write_bytes_to(folder / "s.json", document.dump());
        std::vector<std::string> arguments{"render",         folder / "s.json", "-o",
                                           folder / "x.png", "--size",          "20x15"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const ProgramResult result = lamina_run(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return result.err;
    };
    const char* const reason = "s.json: transfer_function.colormap: found values from 0 to";
    EXPECT_NE(said({{"colormap", "ct-bone"}}, {}).find(reason), std::string::npos);
    EXPECT_NE(said({{"colormap", "ct-bone"}}, {"--density", "2"}).find(reason), std::string::npos);
    for (const std::string& fine :
         {said({{"colormap", "ct-bone"}, {"colormap_range", {0, 255}}}, {}),
          said({{"colormap", "ct-bone"}}, {"--colormap", "greys"}),
          said({{"colormap", "viridis"}, {"points", {{{"value", 0}, {"extinction", 1}}}}}, {})})
        EXPECT_EQ(fine.find("HU"), std::string::npos) << fine;
}

TEST_F(WordsRun, ForAnnotationsKeepWhatTheSceneSaysOfThem) {
    const std::vector<std::string> own{
        "--set",
        R"(image.annotations={"colorbar": {"text": "T"}, "title": {"text": "old", "size": 2}})"};
    std::ofstream(folder / "s.json") << scene(own);
    const ProgramResult result = lamina_run(
        {"scene", folder / "s.json", "-o", "-", "--legend", "--scale-bar", "--title", "new"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const json annotations = json::parse(result.out)["image"]["annotations"];
    EXPECT_EQ(annotations["colorbar"]["text"], "T");
    EXPECT_EQ(annotations["title"]["text"], "new");
    EXPECT_EQ(annotations["title"]["size"], 2);
    EXPECT_EQ(annotations["scale_bar"], true);
    const json set = scene({"--legend", "--set", "image.annotations.colorbar.text=T"});
    EXPECT_EQ(set["image"]["annotations"]["colorbar"]["text"], "T");
}

TEST_F(WordsRun, LightingIsTrueOrFalse) {
    json lit = gaussians_scene(8, 20, 15, 8);
    const auto of_key = [&](const json& lighting) {
        lit["lighting"] = lighting;
        write_bytes_to(folder / "s.json", lit.dump());
        return load_scene(std::string(folder / "s.json")).lighting;
    };
    EXPECT_EQ(of_key(true), Lighting{});
    EXPECT_EQ(of_key(false), std::nullopt);
    EXPECT_EQ(scene({"--set", "lighting=false"}).contains("lighting"), false);
}

// A turntable turns about the picture's up: view 2 of 4 sees the other side, from the same height.
TEST_F(WordsRun, TurntablesTurnAboutTheUpOfThePicture) {
    const ProgramResult drawn =
        run({"--up", "+z", "--elevation", "25", "--turntable", "4", "--context", "cpu"}, "render",
            folder / "v_%d.exr");
    ASSERT_EQ(drawn.exit_code, 0) << drawn.err;
    std::vector<json> cameras;
    for (const char* const name : {"v_0.exr", "v_2.exr"}) {
        const std::string bytes = read_bytes_of(folder / name);
        const std::size_t begin = bytes.find("{\n  \"camera\"");
        ASSERT_NE(begin, std::string::npos);
        const std::size_t end = bytes.find("\n}", begin);
        cameras.push_back(json::parse(bytes.substr(begin, end + 2 - begin))["camera"]);
    }
    const auto number = [&](std::size_t view, const char* key, std::size_t axis) {
        return cameras[view][key][axis].get<double>();
    };
    for (std::size_t axis = 0; axis < 2; ++axis)
        EXPECT_NEAR(number(1, "eye", axis) - number(1, "center", axis),
                    number(0, "center", axis) - number(0, "eye", axis), 1e-12);
    EXPECT_NEAR(number(1, "eye", 2), number(0, "eye", 2), 1e-12);
    EXPECT_EQ(cameras[0]["up"], json::parse("[0.0, 0.0, 1.0]"));
}

// Turntables with a scene's own camera stand upright, too: it tumbled about an `up` that leaned
// with the eye.
TEST_F(WordsRun, TurntablesOfAScenesCameraStandUprightIfElevated) {
    write_bytes_to(folder / "s.json", gaussians_scene(8, 20, 15, 8).dump());
    const ProgramResult drawn =
        lamina_run({"scene", folder / "s.json", "-o", "-", "--elevation", "30", "--azimuth", "10"});
    ASSERT_EQ(drawn.exit_code, 0) << drawn.err;
    EXPECT_EQ(json::parse(drawn.out)["camera"]["up"], json::parse("[0.0, 0.0, 1.0]"));
}

TEST_F(WordsRun, AFileWithoutAVerbNeedsADisplay) {
    const ProgramResult result = lamina_run({folder / "v.nrrd"}, [] {
        unsetenv("DISPLAY");
        unsetenv("WAYLAND_DISPLAY");
    });
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(result.err.find("v.nrrd -o a.png draws it"), std::string::npos) << result.err;
    EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << result.err;
    const ProgramResult none = lamina_run({folder / "none.nrrd"});
    EXPECT_EQ(none.exit_code, 2);
    EXPECT_NE(none.err.find("unknown verb"), std::string::npos) << none.err;
}

}  // namespace
}  // namespace lamina
