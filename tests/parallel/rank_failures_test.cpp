// SPDX-License-Identifier: Apache-2.0
// If a rank fails, the job ends with one message and leaves no files.
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <thread>

#include "mpi_run.h"
#include "support/temporary_folder.h"

namespace lamina {
namespace {

using namespace std::chrono_literals;
using Arguments = std::vector<std::string>;

int lines_of_lamina(const std::string& text) {
    int count = 0;
    for (std::size_t at = text.find("lamina:"); at != std::string::npos;
         at = text.find("lamina:", at + 1))
        ++count;
    return count;
}

class RankFailures : public testing::Test {
  protected:
    void SetUp() override {
        write_bytes_to(
            volume, "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 100 100 100\nencoding: raw\n\n");
        std::ofstream file(volume, std::ios::app | std::ios::binary);
        for (int i = 0; i < 1000000; ++i) file.put(static_cast<char>(i * 7 % 251));
    }
    Arguments command(int ranks, const Arguments& more) const {
        Arguments program{LAMINA_MPI_BINARY, "render", volume, "-o", folder / "a.exr", "--quiet"};
        program.insert(program.end(), more.begin(), more.end());
        return on_ranks(ranks, program);
    }
    void expect_refused(const Arguments& more, int exit_code, const std::string& what) const {
        const ProgramResult result = run_program(command(3, more), allow_root);
        EXPECT_EQ(result.exit_code, exit_code) << result.err;
        EXPECT_NE(result.err.find(what), std::string::npos) << result.err;
        EXPECT_EQ(lines_of_lamina(result.err), 1) << result.err;
        EXPECT_FALSE(std::filesystem::exists(folder / "a.exr"));
    }

    TemporaryFolder folder;
    std::filesystem::path volume = folder / "noise.nrrd";
};

TEST_F(RankFailures, SettingsThatRanksCannotShareAreRefusedByName) {
    expect_refused({"--set", "render.target=fixed8"}, 1, "render.target: found fixed8");
    expect_refused({"--set", "render.slice.tree.factors=[2,2]", "--set", "render.target=float32"},
                   1, "render.slice.tree");
    expect_refused({"--set", "render.slice.dither={}"}, 1, "render.slice.dither");
    expect_refused({"--method", "trace"}, 1, "render.method: found trace, expected slice");
    expect_refused({"--context", "osmesa"}, 2, "--context osmesa");
    expect_refused({"--wire", "short"}, 2, "--wire: found short");
}

TEST_F(RankFailures, MeshesAreRefusedWithTheReason) {
    run_program({LAMINA_BINARY, "generate", "gaussians", "--size", "8,8,8", "-o", volume});
    run_program({LAMINA_BINARY, "mesh", volume, "--kuhn", "-o", folder / "noise.vtu"});
    volume = folder / "noise.vtu";
    expect_refused({}, 1, "render.method: found project, expected slice: parts of a mesh");
}

TEST_F(RankFailures, UnknownInstructionsAreRefusedOnce) {
    const ProgramResult result = run_program(command(3, {}), [] {
        allow_root();
        setenv("LAMINA_INSTRUCTIONS", "MMX", 1);
    });
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_EQ(lines_of_lamina(result.err), 1) << result.err;
}

TEST_F(RankFailures, FilesThatAreCutShortAreNamed) {
    std::filesystem::resize_file(volume, 500000);
    expect_refused({}, 1, "noise.nrrd");
}

// Only the ranks get the limit on file sizes: Open MPI's mpiexec writes files, too, and may hang if
// they cannot grow.
TEST_F(RankFailures, AFullDiskLeavesNothing) {
    Arguments program{"sh", "-c", "trap '' XFSZ; ulimit -f 40; exec \"$0\" \"$@\""};  // 20 KiB
    const Arguments render{LAMINA_MPI_BINARY, "render",  volume,   "-o",
                           folder / "a.exr",  "--quiet", "--size", "200x200"};
    program.insert(program.end(), render.begin(), render.end());
    const ProgramResult result = run_program(on_ranks(2, program), allow_root);
    EXPECT_NE(result.exit_code, 0);
    EXPECT_NE(result.err.find("a.exr: cannot write"), std::string::npos) << result.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "a.exr"));
}

std::vector<pid_t> children_of(pid_t parent) {
    std::ifstream file("/proc/" + std::to_string(parent) + "/task/" + std::to_string(parent) +
                       "/children");
    std::vector<pid_t> children;
    for (pid_t child; file >> child;) children.push_back(child);
    return children;
}

// Starts a job that would take minutes, calls end() once its ranks run, and expects it to end soon.
template <typename End>
void expect_end(const Arguments& command, const std::filesystem::path& picture, const End& end) {
    StartedProgram program(command, allow_root);
    while (children_of(program.id()).size() < 3 && !program.has_ended())
        std::this_thread::sleep_for(10ms);
    std::this_thread::sleep_for(500ms);
    end(program);
    const auto start = std::chrono::steady_clock::now();
    const ProgramResult result = program.wait();
    EXPECT_LT(std::chrono::steady_clock::now() - start, 10s);
    EXPECT_NE(result.exit_code, 0);
    EXPECT_LE(lines_of_lamina(result.err), 1) << result.err;
    EXPECT_FALSE(std::filesystem::exists(picture));
}

TEST_F(RankFailures, AKilledRankEndsAllRanks) {
    for (const std::size_t rank : {0u, 2u}) {
        expect_end(command(3, {"--frames", "3000"}), folder / "a.exr",
                   [&](const StartedProgram& program) {
                       kill(children_of(program.id()).at(rank), SIGKILL);
                   });
    }
}

TEST_F(RankFailures, SignalsEndAllRanks) {
    for (const int signal : {SIGINT, SIGTERM}) {
        expect_end(command(3, {"--frames", "3000"}), folder / "a.exr",
                   [&](const StartedProgram& program) { program.send(signal); });
    }
}

// Each rank has the file open and checks it after every frame.
TEST_F(RankFailures, AFileThatChangesMeanwhileIsNamed) {
    StartedProgram program(command(3, {"--memory", "1M", "--frames", "3000"}),
                           [] { allow_root(); });
    while (children_of(program.id()).size() < 3 && !program.has_ended())
        std::this_thread::sleep_for(10ms);
    std::this_thread::sleep_for(1500ms);
    std::filesystem::resize_file(volume, 500000);
    const ProgramResult result = program.wait();
    EXPECT_NE(result.exit_code, 0);
    EXPECT_NE(result.err.find("noise.nrrd"), std::string::npos) << result.err;
    EXPECT_EQ(lines_of_lamina(result.err), 1) << result.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "a.exr"));
}

}  // namespace
}  // namespace lamina
