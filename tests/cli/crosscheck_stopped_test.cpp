// SPDX-License-Identifier: Apache-2.0
// lamina crosscheck, interrupted and then resumed.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "cli/blobs_scene.h"
#include "cli/lamina_run.h"
#include "cli/started_program.h"
#include "support/temporary_folder.h"

namespace lamina {
namespace {

using nlohmann::json;
using namespace std::chrono_literals;

// Removes what differs between two equal cross-checks: times, and the command with the folder's
// name.
json without_times(json budget) {
    budget.erase("environment");
    budget.erase("findings");  // they contain times
    for (json& each : budget["ladder"]["slicing"]) each.erase("frame_ms");
    for (json& each : budget["ladder"]["projection"]) {
        each.erase("frame_ms");
        each.erase("mesh_ms");
    }
    return budget;
}

class CrosscheckStopped : public testing::Test {
  protected:
    void SetUp() override {
        if (std::string(LAMINA_TETRAHEDRALIZE_BINARY).empty())
            GTEST_SKIP() << "built without TetGen";
        write_bytes_to(folder / "blobs.json", blobs_scene(24, 24, 8).dump());
    }
    std::vector<std::string> command(const std::string& output) const {
        return {
            "crosscheck",   folder / "blobs.json", "-o",        folder / output, "--context", "cpu",
            "--tolerances", ".3,.25,.2,.15",       "--samples", "8,32"};
    }
    ProgramResult resume(const std::string& output) const {
        auto arguments = command(output);
        arguments.emplace_back("--resume");
        return lamina_run(arguments);
    }
    std::size_t steps_kept(const std::string& output) const {
        const std::filesystem::path kept = folder / (output + "/crosscheck-kept");
        if (!std::filesystem::exists(kept)) return 0;
        const std::filesystem::directory_iterator files(kept);
        return static_cast<std::size_t>(
            std::count_if(begin(files), end(files),
                          [](const auto& file) { return file.path().extension() == ".json"; }));
    }
    // Interrupts a cross-check that has kept `steps` steps. Returns false if it ended before that.
    bool interrupt(const std::string& output, std::size_t steps) const {
        auto arguments = command(output);
        arguments.insert(arguments.begin(), LAMINA_BINARY);
        StartedProgram program(arguments);
        while (!program.has_ended() && steps_kept(output) < steps) std::this_thread::sleep_for(1ms);
        program.send(SIGINT);
        const ProgramResult result = program.wait();
        if (result.exit_code == 0) return false;
        EXPECT_EQ(result.exit_code, 130) << result.err;
        EXPECT_NE(result.err.find("/crosscheck-kept; --resume goes on"), std::string::npos)
            << result.err;
        EXPECT_FALSE(std::filesystem::exists(folder / (output + "/report.html")));
        return true;
    }
    json budget(const std::string& output) const {
        return without_times(json::parse(read_bytes_of(folder / (output + "/budget.json"))));
    }
    void expect_same(const std::string& output) const {
        EXPECT_EQ(budget(output), budget("whole"));
        for (const char* name :
             {"traced_volume.exr", "traced_mesh.exr", "sliced.exr", "projected.exr"})
            EXPECT_EQ(read_bytes_of(folder / (output + "/" + name)),
                      read_bytes_of(folder / (std::string("whole/") + name)))
                << name;
        EXPECT_TRUE(std::filesystem::exists(folder / (output + "/report.html")));
        EXPECT_FALSE(std::filesystem::exists(folder / (output + "/crosscheck-kept")));
    }

    TemporaryFolder folder;
};

// Five meshes follow the traced volume, and each keeps two steps: the mesh and its traced picture.
// So 1 step is the traced volume, and 3, 5, 7 and 9 steps include the first mesh, the first two,
// three and four.
TEST_F(CrosscheckStopped, ResumesToTheSamePage) {
    ASSERT_EQ(lamina_run(command("whole")).exit_code, 0);
    int interrupted = 0;
    for (const std::size_t steps : {1, 3, 5, 7, 9}) {
        const std::string output = "after" + std::to_string(steps);
        if (!interrupt(output, steps)) continue;
        ++interrupted;
        EXPECT_GE(steps_kept(output), steps);
        const ProgramResult again = lamina_run(command(output));
        EXPECT_EQ(again.exit_code, 1);
        EXPECT_NE(again.err.find("holds finished steps of a cross-check that was stopped"),
                  std::string::npos)
            << again.err;
        ASSERT_EQ(resume(output).exit_code, 0);
        expect_same(output);
    }
    EXPECT_GE(interrupted, 3);
}

TEST_F(CrosscheckStopped, MakesDamagedStepsAgain) {
    ASSERT_EQ(lamina_run(command("whole")).exit_code, 0);
    if (!interrupt("out", 5)) GTEST_SKIP() << "it had ended before it was interrupted";
    for (const auto& file : std::filesystem::directory_iterator(folder / "out/crosscheck-kept")) {
        if (file.path().extension() != ".json") std::filesystem::resize_file(file.path(), 100);
    }
    const ProgramResult result = resume("out");
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.err.find("the reference is traced again"), std::string::npos) << result.err;
    expect_same("out");
}

}  // namespace
}  // namespace lamina
