// SPDX-License-Identifier: Apache-2.0
// Pictures of data files without a scene: lamina chooses transfer function and camera.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "cli/blobs_scene.h"
#include "cli/lamina_run.h"
#include "image/exr.h"
#include "support/temporary_folder.h"

namespace lamina {
namespace {

using nlohmann::json;

class FirstPicture : public testing::Test {
  protected:
    // Runs lamina and expects success. Returns its stderr.
    std::string run(const std::vector<std::string>& arguments) {
        const ProgramResult result = lamina_run(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return result.err;
    }
    std::string generated(const std::string& name, const std::string& type = "uint8") {
        const std::string file = folder / (name + "_" + type + ".nrrd");
        run({"generate", name, "-o", file, "--type", type, "--size", "24,24,24"});
        return file;
    }
    std::string render(const std::string& input, const std::string& output,
                       std::vector<std::string> more = {}) {
        std::vector<std::string> arguments{"render",    input, "-o",     folder / output,
                                           "--context", "cpu", "--size", "160x120"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run(arguments);
    }
    void expect_same(const std::string& a, const std::string& b) {
        const ProgramResult result =
            lamina_run({"compare", folder / a, folder / b, "--max-linf", "0"});
        EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
    }
    bool same(const std::string& a, const std::string& b) {
        return lamina_run({"compare", folder / a, folder / b, "--max-linf", "0"}).exit_code == 0;
    }
    json document(const std::string& name) { return json::parse(read_bytes_of(folder / name)); }

    TemporaryFolder folder;
};

// Measures of how much a picture shows.
struct Look {
    double covered = 0;  // share of all pixels with an opacity of 8 / 255 or more
    // Share of the covered pixels that are full white in some channel: .9956 or more, which is
    // full_light in render/warnings.cpp.
    double saturated = 0;
    // Number of distinct colours, by hue and brightness, that each cover at least 1 % of the shown
    // pixels. One material has one hue, and light makes it brighter and darker.
    std::size_t kinds = 0;

    explicit Look(const Image& picture) {
        std::map<int, double> found;
        for (std::size_t i = 0; i < picture.rgba.size(); i += 4) {
            const float* const p = &picture.rgba[i];
            if (p[3] < 8.F / 255) continue;
            covered += 1;
            const float most = std::max({p[0], p[1], p[2]}), least = std::min({p[0], p[1], p[2]});
            saturated += most >= .9956F;
            const auto light = static_cast<int>(8 * std::sqrt(std::min(most, 1.F)));
            ++found[light + (most - least > most / 4 ? 100 * (1 + hue(p, most, most - least)) : 0)];
        }
        for (const auto& [kind, count] : found) kinds += count >= covered / 100;
        saturated /= std::max(covered, 1.);
        covered /= static_cast<double>(picture.rgba.size()) / 4;
    }
    // Returns the twelfth of the colour circle.
    static int hue(const float* p, float most, float chroma) {
        const float sixth = most == p[0]   ? (p[1] - p[2]) / chroma + 6
                            : most == p[1] ? (p[2] - p[0]) / chroma + 2
                                           : (p[0] - p[1]) / chroma + 4;
        return static_cast<int>(2 * sixth) % 12;
    }
};

void expect_good(const Image& picture, const std::string& what, std::size_t kinds = 3) {
    const Look look(picture);
    EXPECT_GE(look.covered, .1) << what;
    EXPECT_LE(look.covered, .9) << what;
    EXPECT_LT(look.saturated, .05) << what;
    EXPECT_GE(look.kinds, kinds) << what;
}

TEST_F(FirstPicture, IsGoodForEveryGeneratedVolume) {
    for (const std::string name : {"constant", "marschner-lobb", "gaussians", "sheets", "mixing"}) {
        for (const std::string type : {"uint8", "uint16", "float"}) {
            const std::string said = render(generated(name, type), "p.exr");
            EXPECT_NE(said.find("lamina: transfer function: "), std::string::npos) << said;
            EXPECT_NE(said.find("lamina: camera: "), std::string::npos) << said;
            EXPECT_EQ(said.find("warning"), std::string::npos) << said;
            // Data with one value, or one value beside the background, get one colour.
            const bool plain = name == "constant" || name == "sheets";
            expect_good(read_exr(folder / "p.exr"), name + " " + type, plain ? 1 : 3);
        }
    }
}

TEST_F(FirstPicture, IsGoodForRealData) {
    const char* const data = std::getenv("LAMINA_DATA");
    if (data == nullptr) GTEST_SKIP() << "LAMINA_DATA is not set";
    int count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(data)) {
        const std::string suffix = entry.path().extension();
        if (suffix != ".nrrd" && suffix != ".vtu") continue;
        render(entry.path(), "p.exr");
        expect_good(read_exr(folder / "p.exr"), entry.path());
        ++count;
    }
    EXPECT_GT(count, 0);
}

TEST_F(FirstPicture, TheSceneThatIsWrittenDrawsTheSamePicture) {
    const std::string volume = generated("gaussians");
    run({"mesh", volume, "--kuhn", "-o", folder / "m.vtu", "--quiet"});
    for (const std::string& file : {volume, (folder / "m.vtu").string()}) {
        const std::vector<std::string> look{"--azimuth",  "40",     "--density", "1.5",
                                            "--zoom",     "1.25",   "--range",   "30,220",
                                            "--colormap", "viridis"};
        render(file, "a.exr", look);
        std::vector<std::string> arguments{"scene",           file,     "-o",
                                           folder / "s.json", "--size", "160x120"};
        arguments.insert(arguments.end(), look.begin(), look.end());
        run(arguments);
        render(folder / "s.json", "b.exr");
        expect_same("a.exr", "b.exr");
        const json scene = document("s.json");
        EXPECT_GT(scene["transfer_function"]["points"].size(), 3u);
        EXPECT_TRUE(scene["camera"].contains("eye"));
        EXPECT_EQ(scene["image"]["width"], 160);
    }
}

// A path relative to the scene lets both be moved.
TEST_F(FirstPicture, TheSceneNamesDataBelowItFromThere) {
    const std::string volume = generated("gaussians");
    const std::string name = std::filesystem::path(volume).filename();
    std::filesystem::create_directory(folder / "below");
    std::filesystem::copy_file(volume, folder / "below/v.nrrd");
    run({"scene", folder / "below/v.nrrd", "-o", folder / "s.json", "--size", "160x120",
         "--quiet"});
    EXPECT_EQ(document("s.json")["volume"], "below/v.nrrd");
    render(folder / "s.json", "a.exr");
    render(volume, "b.exr");
    expect_same("a.exr", "b.exr");
    run({"scene", volume, "-o", folder / "below/s.json", "--quiet"});
    EXPECT_EQ(document("below/s.json")["volume"], std::filesystem::canonical(volume).string());
    const json shown = json::parse(lamina_run({"scene", volume, "-o", "-", "--quiet"}).out);
    EXPECT_EQ(std::filesystem::path(shown["volume"].get<std::string>()).filename(), name);
    EXPECT_TRUE(std::filesystem::path(shown["volume"].get<std::string>()).is_absolute());
}

TEST_F(FirstPicture, AFileIsKnownByItsContent) {
    const std::string volume = generated("gaussians");
    render(volume, "a.exr");
    for (const std::string name : {"volume", "volume.vtu", "volume.json"}) {
        std::filesystem::copy_file(volume, folder / name);
        render(folder / name, "b.exr");
        expect_same("a.exr", "b.exr");
    }
    run({"mesh", volume, "--kuhn", "-o", folder / "m.vtu", "--quiet"});
    render(folder / "m.vtu", "a.exr");
    std::filesystem::copy_file(folder / "m.vtu", folder / "mesh.dat");
    render(folder / "mesh.dat", "b.exr");
    expect_same("a.exr", "b.exr");
    write_bytes_to(folder / "letter.txt", "Dear reader");
    const ProgramResult result =
        lamina_run({"render", folder / "letter.txt", "-o", folder / "x.png"});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_NE(result.err.find("letter.txt: unknown kind of file: expected a scene"),
              std::string::npos)
        << result.err;
}

TEST_F(FirstPicture, ShortcutsWorkForScenesToo) {
    write_bytes_to(folder / "s.json", gaussians_scene(16, 160, 120, 32).dump());
    const std::string scene = folder / "s.json";
    render(scene, "plain.exr");
    render(scene, "same.exr", {"--azimuth", "0", "--zoom", "1", "--density", "1"});
    expect_same("plain.exr", "same.exr");
    const std::vector<std::vector<std::string>> changes{
        {"--azimuth", "30"}, {"--elevation", "-20"},    {"--zoom", "2"},
        {"--density", ".5"}, {"--colormap", "inferno"}, {"--range", "100,200"}};
    for (const auto& change : changes) {
        render(scene, "other.exr", change);
        EXPECT_FALSE(same("plain.exr", "other.exr")) << change[0];
    }
    // Each shortcut equals the settings that it stands for.
    render(scene, "a.exr", {"--range", "100,200"});
    render(scene, "b.exr",
           {"--set", "transfer_function.points.0.value=100", "--set",
            "transfer_function.points.1.value=200"});
    expect_same("a.exr", "b.exr");
    render(scene, "a.exr", {"--density", "2"});
    render(scene, "b.exr", {"--set", "transfer_function.points.1.extinction=16"});
    expect_same("a.exr", "b.exr");
    render(scene, "a.png", {"--background", "white"});
    render(scene, "b.png", {"--set", "image.background=[1, 1, 1]"});
    expect_same("a.png", "b.png");
}

TEST_F(FirstPicture, UsesProjectionForASceneWithAMeshAlone) {
    const std::string volume = generated("gaussians");
    run({"mesh", volume, "--kuhn", "-o", folder / "m.vtu", "--quiet"});
    write_bytes_to(folder / "s.json",
                   json{{"version", 1}, {"mesh", (folder / "m.vtu").string()}}.dump());
    render(folder / "s.json", "a.exr");
    render(folder / "s.json", "b.exr", {"--method", "project"});
    expect_same("a.exr", "b.exr");
}

TEST_F(FirstPicture, MistakesInShortcutsAreNamed) {
    const std::string volume = generated("gaussians");
    const std::vector<std::pair<std::vector<std::string>, std::string>> mistakes{
        {{"--range", "3"}, "--range 3: expected LO,HI"},
        {{"--range", "5,2"}, "--range 5,2: expected LO,HI"},
        {{"--size", "800"}, "--size 800: expected WxH"},
        {{"--size", "0x5"}, "--size 0x5: expected 1 pixel or more each"},
        {{"--zoom", "0"}, "--zoom 0: expected"},
        {{"--density", "-1"}, "--density -1: expected"},
        {{"--background", "blurple"}, "image.background"},
        {{"--azimuth", "nan"}, "--azimuth nan: expected"}};
    for (const auto& [mistake, message] : mistakes) {
        std::vector<std::string> arguments{"render", volume, "-o", folder / "x.png"};
        arguments.insert(arguments.end(), mistake.begin(), mistake.end());
        const ProgramResult result = lamina_run(arguments);
        EXPECT_EQ(result.exit_code, 2) << result.err;
        EXPECT_NE(result.err.find(message), std::string::npos) << result.err;
        EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << result.err;
        EXPECT_FALSE(std::filesystem::exists(folder / "x.png"));
    }
}

TEST_F(FirstPicture, OddDataGiveAPictureOrOneLine) {
    const auto nrrd = [&](const std::string& sizes, const std::string& values) {
        write_bytes_to(folder / "v.nrrd", "NRRD0004\ntype: float\ndimension: 3\nsizes: " + sizes +
                                              "\nencoding: ascii\n\n" + values + "\n");
        return (folder / "v.nrrd").string();
    };
    for (const std::string method : {"slice", "trace"}) {
        render(nrrd("2 2 2", "3 3 3 3 3 3 3 3"), "p.exr", {"--method", method});
        render(nrrd("1 1 1", "7"), "p.exr", {"--method", method});
        render(nrrd("3 1 2", "0 1 2 3 4 5"), "p.exr", {"--method", method});
        EXPECT_NE(
            render(nrrd("3 2 2", "nan 1 2 3 4 5 6 7 8 9 10 inf"), "p.exr", {"--method", method})
                .find("2 samples are NaN or infinite"),
            std::string::npos);
        const ProgramResult result = lamina_run(
            {"render", nrrd("2 1 1", "nan nan"), "-o", folder / "x.exr", "--method", method});
        EXPECT_EQ(result.exit_code, 1);
        EXPECT_NE(result.err.find("v.nrrd: all values are NaN or infinite"), std::string::npos)
            << result.err;
    }
    const ProgramResult result =
        lamina_run({"scene", nrrd("2 1 1", "nan nan"), "-o", folder / "x.json"});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_NE(result.err.find("v.nrrd: all values are NaN or infinite"), std::string::npos)
        << result.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "x.json"));
}

TEST_F(FirstPicture, HaveNoAnnotationsInNpyWhichIsSaid) {
    const std::string volume = generated("gaussians"), said = "NPY holds the picture's numbers";
    EXPECT_NE(render(volume, "a.npy", {"--title", "a"}).find(said), std::string::npos);
    EXPECT_NE(render(volume, "a.npy", {"--title", "a", "--method", "trace"}).find(said),
              std::string::npos);
    EXPECT_EQ(render(volume, "a.exr", {"--title", "a"}).find(said), std::string::npos);
    EXPECT_EQ(render(volume, "b.npy").find(said), std::string::npos);
}

TEST_F(FirstPicture, AreNotScenes) {
    const std::string volume = generated("gaussians");
    for (const char* const name : {"s.png", "s.EXR", "s.jpg", "s.mp4"}) {
        const ProgramResult result = lamina_run({"scene", volume, "-o", folder / name});
        EXPECT_EQ(result.exit_code, 2);
        EXPECT_NE(result.err.find("is a picture's name, and a scene is JSON"), std::string::npos)
            << result.err;
        EXPECT_FALSE(std::filesystem::exists(folder / name));
    }
    const ProgramResult data = lamina_run({"scene", volume, "-o", folder / "s.nii.gz"});
    EXPECT_EQ(data.exit_code, 2);
    EXPECT_NE(data.err.find("is a data file's name"), std::string::npos) << data.err;
}

TEST_F(FirstPicture, ATurntableIsFittedAllAround) {
    // A rod, seen from its end in the first view.
    std::string values;
    for (int z = 0; z < 12; ++z) {
        for (int y = 0; y < 12; ++y) {
            for (int x = 0; x < 60; ++x)
                values +=
                    x > 2 && x < 57 && std::abs(y - 6) < 3 && std::abs(z - 6) < 3 ? " 9" : " 0";
        }
    }
    write_bytes_to(folder / "rod.nrrd",
                   "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 60 12 12\nencoding: ascii\n\n" +
                       values + "\n");
    const std::string rod = folder / "rod.nrrd";
    run({"render", rod, "-o", folder / "v_%d.exr", "--turntable", "7", "--size", "80x60",
         "--context", "cpu", "--azimuth", "60", "--quiet"});
    for (int view = 0; view < 7; ++view) {
        const Image picture = read_exr(folder / fmt::format("v_{}.exr", view));
        double covered = 0;
        for (int row = 0; row < 60; ++row) {
            for (int column = 0; column < 80; ++column) {
                const float alpha =
                    picture.rgba[static_cast<std::size_t>(4 * (80 * row + column) + 3)];
                covered += alpha > 0;
                if (row == 0 || row == 59 || column == 0 || column == 79) {
                    EXPECT_EQ(alpha, 0) << view << " " << column << " " << row;
                }
            }
        }
        EXPECT_GT(covered, 200) << view;
    }
}

TEST_F(FirstPicture, APictureThatShowsNothingSaysWhy) {
    auto scene = gaussians_scene(16, 40, 30, 32);
    scene["mesh"] = {{"kuhn", true}};
    const auto warnings = [&](const json& changed, const std::string& method) {
        write_bytes_to(folder / "s.json", changed.dump());
        return run({"render", folder / "s.json", "-o", folder / "p.exr", "--method", method,
                    "--context", "cpu", "--set", "render.trace.tolerance=0.01"});
    };
    const auto expect = [&](const json& changed, const std::string& message) {
        for (const std::string method : {"slice", "project", "trace"}) {
            const std::string said = warnings(changed, method);
            EXPECT_NE(said.find("lamina: warning: "), std::string::npos) << said;
            EXPECT_NE(said.find(message), std::string::npos) << said;
            EXPECT_EQ(said.find("warning"), said.rfind("warning")) << said;  // one warning only
        }
    };
    EXPECT_EQ(warnings(scene, "slice").find("warning"), std::string::npos);
    json bad = scene;
    bad["transfer_function"]["points"][0]["value"] = 300;
    bad["transfer_function"]["points"][1]["value"] = 400;
    expect(bad, "the transfer function shows values above 300, and the data have 0 to 241");
    bad = scene;
    bad["camera"]["center"] = {3, -3, 3};
    expect(bad, "the camera looks away from the data");
    bad = scene;
    bad["camera"]["center"] = {4, 0, 1.3};
    expect(bad, "the camera looks past the data");
    bad = scene;
    bad["transfer_function"]["points"][1]["extinction"] = 1e-6;
    expect(bad, "the largest opacity is");
}

TEST_F(FirstPicture, ASaturatedPictureGivesAWarning) {
    auto scene = gaussians_scene(16, 40, 30, 32);
    scene["transfer_function"]["points"] = {{{"value", 0}, {"extinction", 1000}}};
    write_bytes_to(folder / "s.json", scene.dump());
    for (const std::string method : {"slice", "trace"}) {
        const std::string said = run({"render", folder / "s.json", "-o", folder / "p.exr",
                                      "--method", method, "--context", "cpu"});
        EXPECT_NE(said.find("% of the pixels that show something are saturated"), std::string::npos)
            << said;
    }
}

TEST_F(FirstPicture, ColorsBesideTheDataGiveAWarning) {
    auto scene = gaussians_scene(16, 40, 30, 32);
    scene["transfer_function"] = {
        {"colormap", "viridis"},
        {"colormap_range", {1000, 2000}},
        {"points", {{{"value", 0}, {"extinction", 0}}, {{"value", 255}, {"extinction", 5}}}}};
    write_bytes_to(folder / "s.json", scene.dump());
    const std::string said =
        run({"render", folder / "s.json", "-o", folder / "p.exr", "--context", "cpu"});
    EXPECT_NE(said.find("colours change from 1000 to 2000, and the data have 0 to 241"),
              std::string::npos)
        << said;
}

// An open scene leaves its transfer function or its camera to lamina.
TEST_F(FirstPicture, OtherVerbsTakeDataFilesAndOpenScenes) {
    const std::string volume = generated("gaussians");
    run({"mesh", volume, "--kuhn", "-o", folder / "m.vtu", "--quiet"});
    write_bytes_to(folder / "s.json",
                   json{{"version", 1}, {"volume", volume}, {"mesh", {{"kuhn", true}}}}.dump());
    const std::string said = run({"mesh", folder / "s.json", "-o", folder / "n.vtu"});
    EXPECT_NE(said.find("transfer function: "), std::string::npos) << said;
    run({"order", folder / "s.json", "--eyes", "1", "--size", "16x16", "--quiet"});
    run({"crosscheck", volume, "-o", folder / "cross", "--set", "image.width=32", "--set",
         "image.height=24", "--set", "mesh={\"kuhn\": true}", "--samples", "16", "--quiet"});
    EXPECT_TRUE(std::filesystem::exists(folder / "cross" / "report.html"));
    std::string samples(512, '\0');  // a file without a header
    for (std::size_t i = 0; i < samples.size(); ++i) samples[i] = static_cast<char>(i / 64 * 30);
    write_bytes_to(folder / "v.raw", samples);
    run({"crosscheck", folder / "v.raw", "--raw", "8,8,8,uint8", "-o", folder / "of_raw", "--set",
         "image.width=32", "--set", "image.height=24", "--set", "mesh={\"kuhn\": true}",
         "--samples", "16", "--quiet"});
    EXPECT_TRUE(std::filesystem::exists(folder / "of_raw" / "report.html"));
    const ProgramResult result =
        lamina_run({"crosscheck", folder / "m.vtu", "-o", folder / "none"});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_NE(result.err.find("volume: is missing"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace lamina
