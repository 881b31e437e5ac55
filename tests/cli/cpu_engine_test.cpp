// SPDX-License-Identifier: Apache-2.0
// lamina render --context cpu on the command line.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/blobs_scene.h"
#include "cli/run_program.h"
#include "image/exr.h"
#include "simd/instruction_set.h"
#include "support/temporary_folder.h"

namespace lamina {
namespace {

using nlohmann::json;

class CpuEngine : public testing::Test {
  protected:
    void SetUp() override {
        json scene = gaussians_scene(24, 100, 75, 60);
        scene["mesh"] = {{"tolerance", 0.1}};
        write_bytes_to(folder / "scene.json", scene.dump());
    }

    // `before`: words before the program's name, such as "env" with variables.
    ProgramResult render(const std::string& context, const std::vector<std::string>& options,
                         std::vector<std::string> before = {}) {
        before.insert(before.end(),
                      {LAMINA_BINARY, "render", folder / "scene.json", "--context", context});
        before.insert(before.end(), options.begin(), options.end());
        return run_program(before);
    }

    json stats_of(const std::string& context, const std::string& method) {
        const ProgramResult result = render(
            context, {"--method", method, "-o", folder / "a.exr", "--stats", folder / "s.json"});
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return json::parse(read_bytes_of(folder / "s.json"));
    }

    Image picture(const std::string& method, const std::vector<std::string>& before) {
        const ProgramResult result =
            render("cpu", {"--method", method, "-o", folder / "p.exr"}, before);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return read_exr(folder / "p.exr");
    }

    TemporaryFolder folder;
};

constexpr const char* methods[] = {"slice", "project"};

bool has(const std::string& text, const char* part) {
    return text.find(part) != std::string::npos;
}

// LD_DEBUG makes the dynamic linker print every file that it opens.
TEST_F(CpuEngine, LoadsNoOpenGL) {
    const std::vector<std::string> recorded = {"env", "LD_DEBUG=files"};
    const std::vector<std::string> output = {"-o", folder / "a.exr"};
    ASSERT_TRUE(has(render("osmesa", output, recorded).err, "libOSMesa")) << "nothing is recorded";
    for (const char* method : methods) {
        const ProgramResult result =
            render("cpu", {"-o", folder / "a.exr", "--method", method}, recorded);
        EXPECT_EQ(result.exit_code, 0);
        for (const char* library : {"libOSMesa", "libEGL", "libGL", "libLLVM"})
            EXPECT_FALSE(has(result.err, library)) << method << " loads " << library;
    }
}

TEST_F(CpuEngine, ReportsTimesMemoryAndInstructionsInStatistics) {
    for (const char* method : methods) {
        const json stats = stats_of("cpu", method);
        for (const char* key :
             {"frame_ms", "stages", "samples", "fragments", "tets_drawn", "bytes_gpu", "bytes_host",
              "peak_rss_mb", "context", "plan", "omitted", "counts"}) {
            EXPECT_TRUE(stats.contains(key)) << key;
        }
        const std::string context = stats["context"];
        EXPECT_TRUE(context.starts_with("cpu: " + instruction_set() + ", ")) << context;
        EXPECT_EQ(stats["bytes_gpu"], 0);
        EXPECT_GT(stats["bytes_host"], 100 * 75 * 16);  // at least the picture
        EXPECT_GT(stats["fragments"], 1000);
        EXPECT_GT(stats["stages"]["draw"], 0);
        // Without --frames, the timed frame is the one that is written.
        EXPECT_GT(stats["first_picture_ms"].get<double>(),
                  stats["frame_ms"]["median"].get<double>() +
                      stats["stages"]["set_up"].get<double>() +
                      stats["stages"]["write"].get<double>());
    }
}

// `auto` takes the cpu engine if there is no GPU, and never llvmpipe.
TEST_F(CpuEngine, IsTheDefaultWithoutAGpu) {
    const json stats = stats_of("auto", "slice");
    const std::string context = stats["context"];
    EXPECT_TRUE(context.starts_with("cpu: ") || context.starts_with("EGL: ")) << context;
    EXPECT_EQ(context.find("llvmpipe"), std::string::npos) << context;
    EXPECT_EQ(stats["bytes_gpu"] == 0, context.starts_with("cpu: "));
}

TEST_F(CpuEngine, DrawsTheSameWithAllInstructions) {
    for (const char* method : methods) {
        const Image expected = picture(method, {});
        for (const std::string& name : instruction_sets()) {
            EXPECT_EQ(picture(method, {"env", "LAMINA_INSTRUCTIONS=" + name}).rgba, expected.rgba)
                << method << " with " << name;
        }
    }
}

TEST_F(CpuEngine, DrawsTheSameInOneThread) {
    if (run_program({"taskset", "-c", "0", "true"}).exit_code != 0) GTEST_SKIP() << "no taskset";
    for (const char* method : methods) {
        EXPECT_EQ(picture(method, {"taskset", "-c", "0"}).rgba, picture(method, {}).rgba) << method;
    }
    const ProgramResult result = render("cpu", {"-o", folder / "a.exr"}, {"taskset", "-c", "0"});
    EXPECT_TRUE(has(result.err, ", 1 thread,")) << result.err;
}

// The bytes include attributes, so the plan is the same, too.
TEST_F(CpuEngine, WritesTheSameBytesInOneThread) {
    if (run_program({"taskset", "-c", "0", "true"}).exit_code != 0) GTEST_SKIP() << "no taskset";
    const auto bytes_of = [&](const char* method, const std::vector<std::string>& before) {
        const ProgramResult result =
            render("cpu",
                   {"--method", method, "-o", folder / "a.exr", "--set",
                    "render.slice.samples=auto", "--set", "render.target=auto"},
                   before);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return read_bytes_of(folder / "a.exr");
    };
    for (const char* method : {"slice", "project", "trace"})
        EXPECT_EQ(bytes_of(method, {"taskset", "-c", "0"}), bytes_of(method, {})) << method;
}

TEST_F(CpuEngine, RefusesInstructionsThatTheMachineHasNot) {
    const ProgramResult result =
        render("cpu", {"-o", folder / "a.exr"}, {"env", "LAMINA_INSTRUCTIONS=abacus"});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_TRUE(has(result.err, "LAMINA_INSTRUCTIONS")) << result.err;
    EXPECT_TRUE(has(result.err, instruction_set().c_str())) << result.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "a.exr"));
}

TEST_F(CpuEngine, ExplainsItsPlanWithoutWordsOfOpenGL) {
    const ProgramResult result = render("cpu", {"--explain", "--set", "render.target=emulated"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(has(result.out, "the cpu engine")) << result.out;
    for (const char* word : {"framebuffer", "texture"})
        EXPECT_FALSE(has(result.out, word)) << result.out;
}

TEST_F(CpuEngine, IsRefusedForReproducingAPaper) {
    const ProgramResult result = run_program(
        {LAMINA_BINARY, "reproduce", "lamar", "table3", "-o", folder / "x", "--context", "cpu"});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_TRUE(has(result.err, "needs OpenGL")) << result.err;
}

}  // namespace
}  // namespace lamina
