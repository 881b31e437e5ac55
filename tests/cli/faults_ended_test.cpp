// SPDX-License-Identifier: Apache-2.0
// Programs that are stopped, or whose output folder is removed, while they work.
#include <chrono>
#include <random>
#include <thread>

#include "cli/faults_test_case.h"

namespace lamina {
namespace {

using namespace std::chrono_literals;

class FaultsOfEnds : public FaultsTestCase {
  protected:
    // Waits until the program has a file open in `out`: then its work has begun.
    void wait_for_output(const StartedProgram& program) const {
        const std::filesystem::path list = "/proc/" + std::to_string(program.id()) + "/fd";
        const auto is_output = [&](const std::filesystem::path& descriptor) {
            std::error_code gone;
            return std::filesystem::read_symlink(descriptor, gone)
                .string()
                .starts_with(out.string());
        };
        while (!program.has_ended()) {
            std::error_code gone;
            for (const auto& entry : std::filesystem::directory_iterator(list, gone))
                if (is_output(entry.path())) return;
            std::this_thread::sleep_for(1ms);
        }
    }
    std::vector<std::string> command(const std::vector<std::string>& arguments) const {
        std::vector<std::string> whole{LAMINA_BINARY};
        whole.insert(whole.end(), arguments.begin(), arguments.end());
        return whole;
    }
    std::vector<std::string> long_work(const std::string& method) const {
        return command(rendering(out / "a.exr", {"--method", method, "--frames", "1000000"}));
    }
};

TEST_F(FaultsOfEnds, SignalsLeaveTheOldFileAndGiveTheExitCode) {
    for (const std::string method : {"slice", "project", "trace"}) {
        for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
            for (const auto delay : {0ms, 40ms}) {
                write_bytes_to(out / "a.exr", "old");
                StartedProgram program(long_work(method));
                wait_for_output(program);
                std::this_thread::sleep_for(delay);
                program.send(signal);
                expect_one_line(program.wait(), 128 + signal, {"interrupted, nothing written"});
                EXPECT_EQ(contents(out).size(), 1u);
                EXPECT_EQ(read_bytes_of(out / "a.exr"), "old");
            }
        }
    }
}

// nohup ignores SIGHUP, and shells ignore SIGINT for background jobs.
TEST_F(FaultsOfEnds, IgnoredSignalsStayIgnored) {
    for (const int signal : {SIGINT, SIGHUP}) {
        StartedProgram program(command(rendering(out / "a.exr", {"--frames", "50"})),
                               [&] { std::signal(signal, SIG_IGN); });
        wait_for_output(program);
        program.send(signal);
        EXPECT_EQ(program.wait().exit_code, 0);
        EXPECT_TRUE(std::filesystem::remove(out / "a.exr"));
    }
}

TEST_F(FaultsOfEnds, AFolderThatGoesAwayIsAFailure) {
    StartedProgram program(command(rendering(out / "a.exr", {"--frames", "200"})));
    wait_for_output(program);
    std::filesystem::remove_all(out);
    expect_one_line(program.wait(), 1, {"a.exr", "cannot write", "No such file"});
    EXPECT_FALSE(std::filesystem::exists(out));
}

// Kills the program 25 times, at random moments from its start to a little after its end.
TEST_F(FaultsOfEnds, KillingLeavesTheOldPictureOrTheNewOne) {
    const std::vector<std::string> samples[] = {{"--set", "render.slice.samples=40"},
                                                {"--set", "render.slice.samples=60"}};
    std::string whole[2];
    const auto start = std::chrono::steady_clock::now();
    for (const std::size_t i : {0u, 1u}) {
        make(rendering(out / "a.exr", samples[i]));
        whole[i] = read_bytes_of(out / "a.exr");
    }
    ASSERT_NE(whole[0], whole[1]);
    const std::chrono::duration<double> one = (std::chrono::steady_clock::now() - start) / 2;
    std::mt19937 random(1);
    std::uniform_real_distribution<double> moment(0, 1.1);
    std::string before = whole[1];
    int killed = 0;
    for (std::size_t i = 0; i < 25; ++i) {
        StartedProgram program(command(rendering(out / "a.exr", samples[i % 2])));
        std::this_thread::sleep_for(moment(random) * one);
        program.send(SIGKILL);
        const int exit_code = program.wait().exit_code;
        killed += exit_code == -SIGKILL ? 1 : 0;
        const std::string there = read_bytes_of(out / "a.exr");
        EXPECT_TRUE(there == whole[i % 2] || (there == before && exit_code != 0)) << i;
        before = there;
    }
    EXPECT_GT(killed, 5);
    // A kill may leave an unfinished file beside the output; the next run removes it.
    EXPECT_LE(contents(out).size(), 2u);
    make(rendering(out / "a.exr", samples[0]));
    EXPECT_EQ(contents(out).size(), 1u);
    EXPECT_EQ(read_bytes_of(out / "a.exr"), whole[0]);
}

// The two files of a .node mesh always belong to the same mesh.
TEST_F(FaultsOfEnds, KillingLeavesTwoFilesOfOneMesh) {
    make({"generate", "gaussians", "-o", folder / "other.nrrd", "--size", "15,15,15"});
    const auto meshing = [&](std::size_t i) {
        return command({"mesh", folder / (i == 0 ? "volume.nrrd" : "other.nrrd"), "-o",
                        out / "a.node", "--kuhn", "--quiet"});
    };
    std::string whole[2];
    const auto start = std::chrono::steady_clock::now();
    for (const std::size_t i : {0u, 1u}) {
        ASSERT_EQ(run_program(meshing(i)).exit_code, 0);
        whole[i] = read_bytes_of(out / "a.node") + read_bytes_of(out / "a.ele");
    }
    const std::chrono::duration<double> one = (std::chrono::steady_clock::now() - start) / 2;
    std::mt19937 random(2);
    std::uniform_real_distribution<double> moment(0.5, 1.1);
    for (std::size_t i = 0; i < 15; ++i) {
        StartedProgram program(meshing(i % 2));
        std::this_thread::sleep_for(moment(random) * one);
        program.send(SIGKILL);
        program.wait();
        const std::string node = read_bytes_of(out / "a.node");
        const std::string pair = node + read_bytes_of(out / "a.ele");
        EXPECT_TRUE(node.empty() || pair == whole[0] || pair == whole[1]) << i;
    }
}

}  // namespace
}  // namespace lamina
