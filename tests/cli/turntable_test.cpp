// SPDX-License-Identifier: Apache-2.0
// lamina render --turntable.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>
#include <vector>

#include "cli/blobs_scene.h"
#include "cli/lamina_run.h"
#include "image/exr.h"
#include "lamina/scene.h"
#include "support/temporary_folder.h"

namespace lamina {
namespace {

using nlohmann::json;

class TurntableRun : public testing::Test {
  protected:
    void SetUp() override { write_scene(gaussians_scene(24, 40, 30, 60)); }

    void write_scene(const json& scene) { write_bytes_to(folder / "scene.json", scene.dump()); }

    ProgramResult turn(const std::string& views, const std::string& pattern,
                       const std::vector<std::string>& more = {}) {
        std::vector<std::string> arguments{"render",         folder / "scene.json", "-o",
                                           folder / pattern, "--turntable",         views};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return lamina_run(arguments);
    }
    ProgramResult turn_well(const std::string& pattern, const std::string& says,
                            const std::vector<std::string>& more = {}) {
        const ProgramResult result = turn("4", pattern, more);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        EXPECT_NE(result.err.find(says), std::string::npos) << result.err;
        return result;
    }

    std::map<std::string, std::string> files() const {
        std::map<std::string, std::string> bytes;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path())) {
            if (entry.is_regular_file())
                bytes[entry.path().filename().string()] = read_bytes_of(entry.path());
        }
        return bytes;
    }

    ino_t inode(const std::string& name) const {
        struct stat found = {};
        return stat(std::string(folder / name).c_str(), &found) == 0 ? found.st_ino : 0;
    }

    TemporaryFolder folder;
};

// A view is, bit for bit, the picture of the scene with the turned camera.
TEST_F(TurntableRun, ViewsAreTurnedByEqualAngles) {
    turn_well("turn/v_%02d.exr", "wrote 4 of 4 views as");
    const Camera own = *load_scene(std::string(folder / "scene.json")).camera;
    for (int view = 0; view < 4; ++view) {
        const Camera camera = view == 0 ? own : turned(own, 90 * view);
        const json eye{camera.eye.x, camera.eye.y, camera.eye.z};
        const std::string file = folder / ("turn/v_0" + std::to_string(view) + ".exr");
        ASSERT_EQ(lamina_run({"render", folder / "scene.json", "-o", folder / "one.exr", "--set",
                              "camera.eye=" + eye.dump()})
                      .exit_code,
                  0);
        EXPECT_EQ(read_exr(file).rgba, read_exr(std::string(folder / "one.exr")).rgba) << view;
        // The attributes of the file have the scene with the view's camera.
        EXPECT_NE(read_bytes_of(file).find(json(camera.eye.x).dump()), std::string::npos);
    }
    const auto views = files();
    EXPECT_NE(views.at("v_00.exr"), views.at("v_01.exr"));
    EXPECT_NE(views.at("v_01.exr"), views.at("v_03.exr"));
}

TEST_F(TurntableRun, TheFirstViewIsTheScenesOwnPicture) {
    ASSERT_EQ(lamina_run({"render", folder / "scene.json", "-o", folder / "one.png"}).exit_code, 0);
    turn_well("%d.png", "0.png .. 3.png");
    EXPECT_EQ(read_bytes_of(folder / "0.png"), read_bytes_of(folder / "one.png"));
    for (const std::string method : {"trace", "slice"}) {
        turn_well(method + "%%_%d.npy", "wrote 4 of 4", {"--method", method});
        EXPECT_TRUE(std::filesystem::exists(folder / (method + "%_3.npy")));
    }
}

TEST_F(TurntableRun, WritesIntoTheCurrentFolder) {
    const ProgramResult result =
        lamina_run({"render", "scene.json", "-o", "v_%d.png", "--turntable", "2"}, [this] {
            if (chdir(folder.path().c_str()) != 0) _exit(126);
        });
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.err.find("as v_0.png .. v_1.png"), std::string::npos) << result.err;
    EXPECT_TRUE(std::filesystem::exists(folder / "v_1.png"));
}

TEST_F(TurntableRun, KeepsWholeFiles) {
    turn_well("v_%d.png", "wrote 4 of 4 views");
    const auto whole = files();
    std::filesystem::remove(folder / "v_0.png");
    write_bytes_to(folder / "v_2.png", whole.at("v_2.png").substr(0, 300));
    const ino_t kept = inode("v_1.png");
    turn_well("v_%d.png", "wrote 2 of 4 views as " + std::string(folder / "v_0.png"));
    EXPECT_EQ(files(), whole);
    EXPECT_EQ(inode("v_1.png"), kept);
    const ProgramResult again =
        turn_well("v_%d.png", "4 were there and are kept", {"--stats", folder / "stats.json"});
    EXPECT_NE(again.err.find("wrote 0 of 4"), std::string::npos);
    const json stats = json::parse(read_bytes_of(folder / "stats.json"));
    EXPECT_EQ(stats["frame_ms"]["n"], 0);
    EXPECT_EQ(stats["counts"]["kept_views"], 4);
    turn_well("v_%d.png", "wrote 4 of 4 views", {"--force"});
    EXPECT_NE(inode("v_1.png"), kept);
}

TEST_F(TurntableRun, ViewsOfAnotherSceneAreDrawnAgain) {
    ASSERT_EQ(
        lamina_run({"generate", "gaussians", "-o", folder / "g.nrrd", "--size", "8,8,8"}).exit_code,
        0);
    json scene = gaussians_scene(24, 40, 30, 60);
    scene["volume"] = "g.nrrd";
    write_scene(scene);
    turn_well("v_%d.png", "wrote 4 of 4 views");
    turn_well("v_%d.png", "wrote 0 of 4 views");
    turn_well("v_%d.png", "wrote 4 of 4 views", {"--set", "image.width=44"});
    turn_well("v_%d.png", "wrote 4 of 4 views");
    ASSERT_EQ(
        lamina_run({"generate", "mixing", "-o", folder / "g.nrrd", "--size", "8,8,8"}).exit_code,
        0);
    turn_well("v_%d.png", "wrote 4 of 4 views");
    EXPECT_NE(turn("5", "v_%d.png").err.find("wrote 5 of 5 views"), std::string::npos);
    // A record that cannot be read counts as none.
    write_bytes_to(folder / "v_turntable.json", "{");
    turn_well("v_%d.png", "wrote 4 of 4 views");
}

TEST_F(TurntableRun, FilesOfOthersAreLeftAlone) {
    write_bytes_to(folder / "v_2.png", "precious");
    const auto before = files();
    const ProgramResult refused = turn("4", "v_%d.png");
    EXPECT_EQ(refused.exit_code, 1);
    EXPECT_NE(refused.err.find("v_2.png"), std::string::npos) << refused.err;
    EXPECT_NE(refused.err.find("--force"), std::string::npos) << refused.err;
    EXPECT_EQ(files(), before);
    turn_well("v_%d.png", "wrote 4 of 4 views", {"--force"});
    EXPECT_NE(read_bytes_of(folder / "v_2.png"), "precious");
    std::filesystem::create_symlink(folder / "scene.json", folder / "w_1.png");
    EXPECT_EQ(turn("4", "w_%d.png", {"--force"}).exit_code, 2);
}

TEST_F(TurntableRun, ContinuesAfterAStop) {
    const std::vector<std::string> arguments{
        LAMINA_BINARY,         "render",  folder / "scene.json", "-o",
        folder / "s_%03d.png", "--quiet", "--turntable",         "300"};
    StartedProgram program(arguments);
    const std::filesystem::path third = std::string(folder / "s_002.png");
    while (!std::filesystem::exists(third) && !program.has_ended())
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    program.send(SIGINT);
    const ProgramResult ended = program.wait();
    EXPECT_EQ(ended.exit_code, 130);
    const auto stopped = files();
    const std::string there = std::to_string(stopped.size() - 3) + " of 300 views are there";
    EXPECT_NE(ended.err.find(there), std::string::npos) << ended.err << there;
    ASSERT_LT(stopped.size(), 300u);
    EXPECT_FALSE(stopped.contains("s_299.png"));
    const ProgramResult rest = turn("300", "s_%03d.png");
    ASSERT_EQ(rest.exit_code, 0) << rest.err;
    // Finished views are kept: all files but the scene, the record and the list of lamina's files.
    const std::string kept = std::to_string(stopped.size() - 3) + " were there and are kept";
    EXPECT_NE(rest.err.find(kept), std::string::npos) << rest.err << kept;
    for (const auto& [name, bytes] : stopped) {
        if (name.ends_with(".png")) {
            EXPECT_EQ(read_bytes_of(folder / name), bytes) << name;
        }
    }
    EXPECT_TRUE(files().contains("s_299.png"));
}

TEST_F(TurntableRun, ExitsWith2ForMistakes) {
    const auto before = files();
    const auto expect_mistake = [&](const std::vector<std::string>& options,
                                    const std::string& part) {
        std::vector<std::string> arguments{"render", folder / "scene.json"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        const ProgramResult result = lamina_run(arguments);
        EXPECT_EQ(result.exit_code, 2) << result.err;
        EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
        EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
        EXPECT_EQ(files(), before);
    };
    for (const char* pattern : {"v.png", "v_%d_%d.png", "v_%s.png", "v_%4d.png", "v_%0d.png",
                                "v_%.png", "v_%", "d%d/v.png", "v_%%d.png", "v_%02x.png", "%0"})
        expect_mistake({"--turntable", "4", "-o", folder / pattern}, pattern);
    expect_mistake({"--turntable", "4", "-o", folder / "v_%d.jpeg"}, ".jpeg");
    expect_mistake({"--turntable", "0", "-o", folder / "v_%d.png"}, "--turntable");
    expect_mistake({"--turntable", "x", "-o", folder / "v_%d.png"}, "--turntable");
    expect_mistake({"--turntable", "4", "-o", "-"}, "number");
    expect_mistake({"--turntable", "4", "--explain"}, "-o FILE");
    expect_mistake({"--turntable", "4", "-o", folder / "v_%d.png", "--frames", "3"}, "--frames");
    expect_mistake({"--force", "-o", folder / "v.png"}, "--turntable");
}

}  // namespace
}  // namespace lamina
