// SPDX-License-Identifier: Apache-2.0
// Films of lamina render that are refused, fail or are stopped.
#include <linux/capability.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/stat.h>

#include <chrono>
#include <thread>

#include "cli/film_test_case.h"

namespace lamina {
namespace {

using nlohmann::json;

class FilmStopped : public FilmTest {
  protected:
    // Writes a program ffmpeg that knows all encoders and else does this, in sh. Returns what makes
    // it the only one in PATH.
    std::function<void()> with_ffmpeg(const std::string& script) {
        std::filesystem::create_directories(folder / "bin");
        const std::string program = folder / "bin/ffmpeg";
        write_bytes_to(program,
                       "#!/bin/sh\ncase \"$*\" in *-encoders*) echo V libx264 "
                       "libvpx-vp9; exit 0;; esac\n" +
                           script);
        chmod(program.c_str(), 0755);
        return [path = (folder / "bin").string()] { setenv("PATH", path.c_str(), 1); };
    }
    bool exists(const std::string& name) const { return std::filesystem::exists(folder / name); }
};

void wait_until(const std::function<bool()>& happened) {
    while (!happened()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

TEST_F(FilmStopped, MistakesAreFoundBeforeAnyFrameIsDrawn) {
    const std::vector<std::string> turn{"--turntable", "2"};
    const auto with = [&](const std::vector<std::string>& more) {
        std::vector<std::string> all = turn;
        all.insert(all.end(), more.begin(), more.end());
        return all;
    };
    expect_refusal(2, "film.mp4", {}, {"several frames", "--turntable N", "--path"});
    expect_refusal(2, "film.mp4", with({"--size", "31x20"}), {"31 x 20", "--size 32x20"});
    expect_refusal(2, "film.mp4", with({"--size", "30x21"}), {"30 x 21", "--size 30x22"});
    expect_refusal(2, "film.mp4", with({"--transparent"}), {".mp4", ".webm or .apng"});
    expect_refusal(2, "film.gif", with({"--transparent"}), {".gif", ".webm or .apng"});
    expect_refusal(2, "film.apng", with({"--fps", "0"}), {"--fps"});
    expect_refusal(2, "film.gif", with({"--fps", "60"}), {"--fps 60", "at most 50", ".gif"});
    expect_refusal(2, "film.apng", with({"--resume", "--force"}), {"--resume and --force"});
    expect_refusal(2, "film.apng", with({"--path", "p.json"}), {"--path", "--turntable"});
    expect_refusal(2, "v.png", {"--path", "p.json"}, {"out_%04d.png"});
    expect_refusal(2, "v_%d.png", with({"--fps", "5"}), {"--fps", "film.mp4"});
    expect_refusal(2, "v_%d.png", with({"--resume"}), {"--resume", "film.mp4"});
    expect_refusal(2, "v.jpg", {}, {"v.jpg", "JPEG would add errors", ".png, .exr or .npy"});
    expect_refusal(1, "film.apng", {"--path", folder / "absent.json"}, {"absent.json"});
    expect_refusal(2, "film.apng", {"--path", folder / "scene.json", "--zoom", "2"}, {"--zoom"});
    EXPECT_FALSE(exists("film.mp4.frames"));
    EXPECT_FALSE(exists("film.apng.frames"));
}

// Highlights add light without covering more.
TEST_F(FilmStopped, LightThatStraightAlphaCannotHoldIsCounted) {
    json scene = gaussians_scene(16, 48, 36, 40);
    scene["lighting"] = {{"specular", 5}};
    write_scene(scene);
    const ProgramResult result = render("v.png", {"--transparent"});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_NE(result.err.find("pixels shine more than they cover, beyond straight alpha, and were"),
              std::string::npos)
        << result.err;
    EXPECT_EQ(read_png(folder / "v.png").channels, 4);
}

TEST_F(FilmStopped, WithoutFfmpegItSaysWhatToInstall) {
    std::filesystem::create_directory(folder / "empty");
    const auto without = [path = (folder / "empty").string()] { setenv("PATH", path.c_str(), 1); };
    expect_refusal(1, "film.mp4", {"--turntable", "2"}, {"no program ffmpeg", "apt install ffmpeg"},
                   without);
    expect_refusal(1, "film.gif", {"--turntable", "2"}, {"has no encoder gif"}, with_ffmpeg(""));
    EXPECT_FALSE(exists("film.mp4.frames"));
    EXPECT_EQ(render("film.apng", {"--turntable", "2"}, without).exit_code, 0);
}

TEST_F(FilmStopped, AFailureOfFfmpegIsOneLineAndKeepsTheFrames) {
    const auto failing = with_ffmpeg("echo 'a\tb' >&2; echo 'it broke' >&2; exit 3\n");
    const ProgramResult failed = render("film.mp4", {"--turntable", "3"}, failing);
    EXPECT_EQ(failed.exit_code, 1);
    const std::string line = failed.err.substr(failed.err.rfind("lamina: "));
    EXPECT_NE(line.find("film.mp4: ffmpeg failed (exit code 3): it broke"), std::string::npos);
    EXPECT_NE(line.find("--resume"), std::string::npos) << line;
    EXPECT_EQ(failed.err.find("a\tb"), std::string::npos);
    EXPECT_FALSE(exists("film.mp4"));
    EXPECT_TRUE(exists("film.mp4.frames/frame_00002.png"));
    // An end without a failure, too.
    EXPECT_NE(render("film.mp4", {"--turntable", "3", "--resume"}, with_ffmpeg("kill -9 $$"))
                  .err.find("ended by signal 9"),
              std::string::npos);
    EXPECT_FALSE(exists("film.mp4"));
    expect_refusal(1, "film.mp4", {"--turntable", "3"}, {"film.mp4.frames", "--resume goes on"});
    expect_refusal(1, "film.mp4", {"--turntable", "3", "--resume", "--density", "2"},
                   {"frame_turntable.json", "another scene", "--force"});
    // The frames suffice: a program that copies its input shows what it is given.
    const auto copying = with_ffmpeg("/bin/cat >/proc/self/fd/3\n");
    const ProgramResult resumed = render(
        "film.mp4", {"--turntable", "3", "--resume", "--stats", folder / "stats.json"}, copying);
    EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
    EXPECT_EQ(json::parse(read_bytes_of(folder / "stats.json"))["counts"]["kept_views"], 3);
    EXPECT_FALSE(exists("film.mp4.frames"));
    EXPECT_EQ(render("v_%d.png", {"--turntable", "3"}).exit_code, 0);
    std::string frames;
    for (const char* name : {"v_0.png", "v_1.png", "v_2.png"})
        frames += read_bytes_of(folder / name);
    EXPECT_EQ(read_bytes_of(folder / "film.mp4"), frames);
}

TEST_F(FilmStopped, AStoppedFilmGoesOn) {
    StartedProgram program({LAMINA_BINARY, "render", folder / "scene.json", "-o",
                            folder / "film.apng", "--turntable", "300", "--quiet"});
    wait_until([&] { return exists("film.apng.frames/frame_00002.png") || program.has_ended(); });
    program.send(SIGINT);
    const ProgramResult ended = program.wait();
    EXPECT_EQ(ended.exit_code, 130);
    EXPECT_NE(ended.err.find("of 300 views are there; --resume goes on"), std::string::npos)
        << ended.err;
    EXPECT_FALSE(exists("film.apng"));
    EXPECT_FALSE(exists("film.apng.frames/frame_00299.png"));
    write_bytes_to(folder / "film.apng.frames/own.txt", "precious");
    const ProgramResult resumed =
        render("film.apng", {"--turntable", "300", "--resume", "--stats", folder / "stats.json"});
    EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
    EXPECT_GE(json::parse(read_bytes_of(folder / "stats.json"))["counts"]["kept_views"], 3);
    // The folder stays if something else is in it.
    EXPECT_EQ(read_bytes_of(folder / "film.apng.frames/own.txt"), "precious");
    EXPECT_FALSE(exists("film.apng.frames/frame_00000.png"));
    std::filesystem::remove_all(folder / "film.apng.frames");
    render_well("whole.apng", {"--turntable", "300"});
    EXPECT_EQ(read_bytes_of(folder / "film.apng"), read_bytes_of(folder / "whole.apng"));
}

TEST_F(FilmStopped, AFilmThatIsStoppedBeforeItsFirstFrameLeavesNothing) {
    StartedProgram program({LAMINA_BINARY, "render", folder / "scene.json", "-o",
                            folder / "film.apng", "--turntable", "3", "--quiet", "--method",
                            "trace", "--size", "4000x3000"});
    wait_until([&] { return exists("film.apng.frames/lamina-files.txt") || program.has_ended(); });
    program.send(SIGINT);
    const ProgramResult ended = program.wait();
    EXPECT_EQ(ended.exit_code, 130);
    EXPECT_NE(ended.err.find("interrupted, nothing written"), std::string::npos) << ended.err;
    EXPECT_FALSE(exists("film.apng.frames"));
}

// A program that reads nothing and never ends by itself is ended, and leaves no zombie.
TEST_F(FilmStopped, CtrlCEndsFfmpeg) {
    const std::string id = folder / "id";
    const auto hanging = with_ffmpeg("echo $$ >" + id + ".new; /bin/mv " + id + ".new " + id +
                                     "; exec /bin/sleep 1000\n");
    StartedProgram program({LAMINA_BINARY, "render", folder / "scene.json", "-o",
                            folder / "film.mp4", "--turntable", "3", "--quiet"},
                           hanging);
    wait_until([&] { return exists("id") || program.has_ended(); });
    program.send(SIGINT);
    const ProgramResult ended = program.wait();
    EXPECT_EQ(ended.exit_code, 130);
    EXPECT_NE(ended.err.find("all 3 frames are there; --resume goes on"), std::string::npos)
        << ended.err;
    EXPECT_EQ(kill(std::stoi(read_bytes_of(id)), 0), -1);
    EXPECT_FALSE(exists("film.mp4"));
    EXPECT_TRUE(exists("film.mp4.frames/frame_00002.png"));
}

// Films replace a file as pictures do: its mode stays, and one that is read-only is no obstacle.
TEST_F(FilmStopped, AReadOnlyFilmIsReplacedAndStaysReadOnly) {
    write_bytes_to(folder / "film.mp4", "old");
    chmod((folder / "film.mp4").c_str(), 0444);
    const auto copying = with_ffmpeg("/bin/cat >/proc/self/fd/3\n");
    const ProgramResult result = render("film.mp4", {"--turntable", "2"}, [&] {
        copying();
        prctl(PR_CAPBSET_DROP, CAP_DAC_OVERRIDE);  // root could write everything
    });
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(read_bytes_of(folder / "film.mp4").substr(1, 3), "PNG");
    struct stat found = {};
    ASSERT_EQ(stat((folder / "film.mp4").c_str(), &found), 0);
    EXPECT_EQ(found.st_mode & 0777, 0444);
}

TEST_F(FilmStopped, FramesOfOthersAreLeftAlone) {
    std::filesystem::create_directory(folder / "film.apng.frames");
    write_bytes_to(folder / "film.apng.frames/frame_00001.png", "precious");
    expect_refusal(1, "film.apng", {"--turntable", "2"}, {"frame_00001.png", "--force"});
    EXPECT_EQ(read_bytes_of(folder / "film.apng.frames/frame_00001.png"), "precious");
}

}  // namespace
}  // namespace lamina
