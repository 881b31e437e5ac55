// SPDX-License-Identifier: Apache-2.0
// lamina render.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "cli/blobs_scene.h"
#include "cli/run_program.h"
#include "image/difference.h"
#include "image/exr.h"
#include "image/npy.h"
#include "support/temporary_folder.h"

namespace lamina {
namespace {

using namespace std::string_literals;

using nlohmann::json;

class Render : public testing::Test {
  protected:
    void SetUp() override {
        scene = gaussians_scene(24, 40, 30, 60);
        write("scene.json", scene);
    }

    void write(const std::string& name, const json& document) {
        write_bytes_to(folder / name, document.dump());
    }

    ProgramResult render(const std::vector<std::string>& options,
                         const std::string& scene_name = "scene.json") {
        std::vector<std::string> arguments{LAMINA_BINARY, "render", folder / scene_name};
        arguments.insert(arguments.end(), options.begin(), options.end());
        return run_program(arguments);
    }

    // Expects one line on stderr with all of `parts`, the exit code `code`, and no new file.
    void expect_failure(const json& bad, const std::vector<std::string>& parts, int code = 1,
                        const std::vector<std::string>& more = {}) {
        write("bad.json", bad);
        const auto files = [&] {
            return std::distance(std::filesystem::directory_iterator(folder.path()), {});
        };
        const auto before = files();
        std::vector<std::string> options{"-o", folder / "bad.exr"};
        options.insert(options.end(), more.begin(), more.end());
        const ProgramResult result = render(options, "bad.json");
        EXPECT_EQ(result.exit_code, code) << result.err;
        EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
        for (const std::string& part : parts)
            EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
        EXPECT_EQ(files(), before);
    }

    json with(const std::string& pointer, json value) {
        json changed = scene;
        changed[json::json_pointer(pointer)] = std::move(value);
        return changed;
    }

    // Expects that the time to the first picture includes the stages that are done one after the
    // other.
    static void expect_first_picture_has_its_stages(const json& stats) {
        double sum = 0;
        for (const char* stage : {"load", "context", "measure", "plan", "set_up", "trace", "write"})
            sum += stats["stages"].value(stage, 0.0);
        EXPECT_GT(sum, 0);
        EXPECT_GE(stats["first_picture_ms"], sum);
    }

    TemporaryFolder folder;
    json scene;
};

TEST_F(Render, SliceAndTraceAgree) {
    ASSERT_EQ(render({"-o", folder / "slice.exr", "--quiet"}).exit_code, 0);
    ASSERT_EQ(render({"-o", folder / "trace.exr", "--method", "trace"}).exit_code, 0);
    ASSERT_EQ(render({"-o", folder / "trace.npy", "--method", "trace"}).exit_code, 0);
    const Image slice = read_exr(folder / "slice.exr"), trace = read_exr(folder / "trace.exr");
    EXPECT_LT(image_error(slice, trace).all.linf, 1);
    // The two files have the same picture in float32 and in float64.
    EXPECT_LT(image_error(trace, read_npy(folder / "trace.npy")).all.linf, 255 * 6e-8);
}

TEST_F(Render, GivesIdenticalFilesTwice) {
    for (const char* name : {"a.exr", "b.exr"}) {
        ASSERT_EQ(render({"-o", folder / name, "--context", "osmesa"}).exit_code, 0);
    }
    EXPECT_EQ(read_bytes_of(folder / "a.exr"), read_bytes_of(folder / "b.exr"));
}

TEST_F(Render, StatsHaveAllKeysAndConsistentTimes) {
    ASSERT_EQ(render({"-o", folder / "a.png", "--stats", folder / "s.json", "--frames", "3",
                      "--context", "osmesa"})
                  .exit_code,
              0);
    const json stats = json::parse(read_bytes_of(folder / "s.json"));
    for (const char* key : {"frame_ms", "stages", "samples", "fragments", "tets_drawn", "bytes_gpu",
                            "work", "peak_rss_mb", "context", "plan", "omitted", "counts"}) {
        EXPECT_TRUE(stats.contains(key)) << key;
    }
    EXPECT_EQ(stats["frame_ms"]["n"], 3);
    expect_first_picture_has_its_stages(stats);
    EXPECT_LE(stats["frame_ms"]["min"], stats["frame_ms"]["median"]);
    EXPECT_LE(stats["frame_ms"]["median"], stats["frame_ms"]["max"]);
    EXPECT_EQ(stats["samples"], 60);
    EXPECT_EQ(stats["fragments"], 0);  // a compute shader marches through all slabs
    EXPECT_GT(stats["bytes_gpu"], 40 * 30 * 16);
    ASSERT_EQ(render({"-o", folder / "t.png", "--stats", folder / "t.json", "--method", "trace"})
                  .exit_code,
              0);
    const json trace = json::parse(read_bytes_of(folder / "t.json"));
    expect_first_picture_has_its_stages(trace);
    EXPECT_GT(trace["error_estimate"], 0);
    EXPECT_LE(trace["error_estimate"], 1e-5);
}

TEST_F(Render, FramesDoNotChangeTheWrittenPicture) {
    ASSERT_EQ(render({"-o", folder / "a.exr"}).exit_code, 0);
    for (const std::vector<std::string>& turn :
         {std::vector<std::string>{}, {"--turn-by", "-10"}}) {
        std::vector<std::string> options{"-o", folder / "b.exr", "--frames", "2"};
        options.insert(options.end(), turn.begin(), turn.end());
        ASSERT_EQ(render(options).exit_code, 0);
        EXPECT_EQ(read_bytes_of(folder / "a.exr"), read_bytes_of(folder / "b.exr"));
    }
}

TEST_F(Render, WarmUpDrawsFramesThatAreNotTimed) {
    const auto spans = [&](const std::vector<std::string>& more) {
        std::vector<std::string> options{
            "-o",      folder / "a.exr",  "--profile", folder / "p.json",
            "--stats", folder / "s.json", "--frames",  "2"};
        options.insert(options.end(), more.begin(), more.end());
        EXPECT_EQ(render(options).exit_code, 0);
        EXPECT_EQ(json::parse(read_bytes_of(folder / "s.json"))["frame_ms"]["n"], 2);
        std::map<std::string, int> counts;
        const json profile = json::parse(read_bytes_of(folder / "p.json"));
        for (const json& event : profile["traceEvents"]) ++counts[event["name"]];
        return counts;
    };
    std::map<std::string, int> cold = spans({}), warm = spans({"--warm-up", "0.001"});
    EXPECT_EQ(warm["frame"], cold["frame"]);
    EXPECT_GT(warm["geometry"], cold["geometry"]);
}

TEST_F(Render, ExplainSaysWhatIsLeftOut) {
    const ProgramResult result = render(
        {"--explain", "--set", "camera.projection=orthographic", "--set", "camera.height=2"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.out.find("perspective"), std::string::npos) << result.out;
    EXPECT_NE(render({"--explain", "--no-omit"}).out.find("nothing"), std::string::npos);
    EXPECT_EQ(render({"--explain", "--no-omit=perspective"}).exit_code, 0);
}

TEST_F(Render, IsSilentIfAskedToBeQuiet) {
    const ProgramResult result = render({"-o", folder / "a.exr", "--quiet"});
    EXPECT_EQ(result.out + result.err, "");
}

TEST_F(Render, ExitsWith2ForMistakesOfUsage) {
    const std::vector<std::vector<std::string>> mistakes = {
        {"-o", folder / "a.exr", "--set", "render.slice.sampels=8"},
        {"-o", folder / "a.exr", "--set", "render.slice.samples=-8"},
        {"-o", folder / "a.exr", "--set", "nonsense"},
        {"-o", folder / "a.exr", "--method", "paint"},
        {"-o", folder / "a.exr", "--context", "directx"},
        {"-o", folder / "a.exr", "--plain"},
        {"-o", folder / "a.exr", "--plain", "--method", "slice"},
        {"-o", folder / "a.exr", "--no-omit=nothing"},
        {"-o", folder / "a.exr", "--frames", "0"},
        {"-o", folder / "a.exr", "--turn-by", "10"},
        {"-o", folder / "a.exr", "--warm-up", "1"},
        {"-o", folder / "a.exr", "--frames", "2", "--turn-by", "181"},
        {"-o", folder / "a.exr", "--stats", folder / "." / "a.exr"},
        {"-o", folder / "a.exr", "--stats", folder / "scene.json"},
        {"-o", folder / "a.jpeg"},
        {},
        {"--bogus"},
    };
    for (const auto& options : mistakes) {
        const ProgramResult result = render(options);
        EXPECT_EQ(result.exit_code, 2) << result.err;
        EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    }
}

TEST_F(Render, ReportsBadScenesInOneLineAndWritesNothing) {
    expect_failure(with("/colour", 1), {"bad.json", "colour", "unknown key"});
    expect_failure(with("/image/width", 0), {"image.width", "found 0"});
    expect_failure(with("/image", {{"width", 1000000}, {"height", 1000000}}),
                   {"image.width", "1000000"});
    expect_failure(with("/camera/eye", {0.5, 0.5, 0.5}), {"camera"});
    expect_failure(with("/transfer_function/points/1/extinction", -1), {"extinction", "found -1"});
    expect_failure(with("/transfer_function/points/1/value", -1), {"points.1.value", "found -1"});
    expect_failure(with("/volume", "none.nrrd"), {"none.nrrd", "no such file"});
    expect_failure(with("/volume/generate", "teapot"), {"teapot"});
    expect_failure(with("/camera/eye", {1e300, 0, 0}), {"camera.eye", "1e100"});
    const ProgramResult unwritable = render({"-o", "/nowhere/at/all.exr"});
    EXPECT_EQ(unwritable.exit_code, 1);
    EXPECT_NE(unwritable.err.find("/nowhere/at/all.exr"), std::string::npos);
}

TEST_F(Render, RefusesSettingsThatCannotBeLit) {
    const json light{{"smallest_gradient", 1}};
    json mesh = with("/lighting", light);
    mesh["mesh"] = {{"kuhn", true}};
    mesh["render"] = {{"method", "project"}};
    for (const char* const coloring : {"vertex", "attenuation"}) {
        mesh["render"]["project"] = {{"coloring", coloring}};
        expect_failure(mesh, {"render.project.coloring", coloring, "\"analytic\""});
    }
    mesh["render"]["project"] = {{"geometry", "triangles"}};
    expect_failure(mesh, {"render.project", "\"triangles\"", "silhouettes"});
    mesh["render"]["project"] = {{"table", {{"scalar", 16}}}};
    expect_failure(mesh, {"render.project.table", "lighting"});
    expect_failure(with("/lighting", {{"power", 0}}), {"lighting.power: found 0", "1 to 1000"});
}

// The resolved scene has the smallest gradient that was chosen, and draws the same picture.
TEST_F(Render, TracesLitScenes) {
    write("lit.json", with("/lighting", json::object()));
    write("unlit.json", scene);
    const auto trace = [&](const std::string& name) {
        const ProgramResult result =
            render({"--method", "trace", "-o", folder / (name + ".npy")}, name + ".json");
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return result.err;
    };
    EXPECT_NE(trace("lit").find("smallest gradient"), std::string::npos);
    trace("unlit");
    EXPECT_NE(read_bytes_of(folder / "lit.npy"), read_bytes_of(folder / "unlit.npy"));
    const ProgramResult resolved =
        run_program({LAMINA_BINARY, "scene", folder / "lit.json", "-o", folder / "resolved.json"});
    EXPECT_EQ(resolved.exit_code, 0) << resolved.err;
    EXPECT_EQ(trace("resolved").find("smallest gradient"), std::string::npos);
    EXPECT_EQ(read_bytes_of(folder / "lit.npy"), read_bytes_of(folder / "resolved.npy"));
}

// The tracer's tolerance is 1e-5; the plain twin's error is far smaller. tools/fuzz_scenes has the
// same bound.
TEST_F(Render, TracesWithThePlainTracerWithinTolerance) {
    const auto trace = [&](const std::string& name, const std::vector<std::string>& more) {
        std::vector<std::string> options{"--method", "trace",
                                         "-o",       folder / (name + ".npy"),
                                         "--stats",  folder / (name + ".json")};
        options.insert(options.end(), more.begin(), more.end());
        const ProgramResult result = render(options);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return json::parse(read_bytes_of(folder / (name + ".json")));
    };
    trace("traced", {});
    const json plain = trace("plain", {"--plain"});
    EXPECT_EQ(plain["context"], "plain tracer");
    EXPECT_GT(plain["error_estimate"], 0);
    EXPECT_LE(plain["error_estimate"], 1e-7);
    const double off =
        image_error(read_npy(folder / "traced.npy"), read_npy(folder / "plain.npy")).all.linf;
    EXPECT_LE(off, 255 * 1e-5);
    EXPECT_NE(read_bytes_of(folder / "traced.npy"), read_bytes_of(folder / "plain.npy"));
    const ProgramResult sliced = render({"-o", folder / "a.exr", "--plain"});
    EXPECT_NE(sliced.err.find("--plain: expected the method trace, found slice"), std::string::npos)
        << sliced.err;
}

TEST_F(Render, OutputsAreRegularFilesAndLinksStayLinks) {
    write_bytes_to(folder / "target.json", "old");
    std::filesystem::create_symlink(folder / "target.json", folder / "link.json");
    ASSERT_EQ(render({"-o", folder / "a.exr", "--stats", folder / "link.json"}).exit_code, 0);
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.json"));
    EXPECT_NE(read_bytes_of(folder / "target.json"), "old");
    const ProgramResult device = render({"-o", folder / "b.exr", "--stats", "/dev/null"});
    EXPECT_EQ(device.exit_code, 1);
    EXPECT_NE(device.err.find("/dev/null"), std::string::npos);
    EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
    EXPECT_FALSE(std::filesystem::exists(folder / "b.exr"));
}

TEST_F(Render, ReportsBadVolumesInOneLineAndWritesNothing) {
    write_bytes_to(
        folder / "huge.nrrd",
        "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 16384 16384 4096\nencoding: raw\n\nabc");
    expect_failure(with("/volume", "huge.nrrd"), {"huge.nrrd"});
    write_bytes_to(folder / "cut.nrrd",
                   "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 8 8 8\nencoding: "
                   "gzip\n\n\x1f\x8b\x08\0\0\0\0\0\0\x03"s);
    expect_failure(with("/volume", "cut.nrrd"), {"cut.nrrd"});
    std::string floats =
        "NRRD0004\ntype: float\ndimension: 3\nsizes: 2 2 2\nencoding: text\n\n0 1 0.5 nan 1 0 0 "
        "0.2\n";
    write_bytes_to(folder / "nan.nrrd", floats);
    expect_failure(with("/volume", "nan.nrrd"), {"nan.nrrd", "1 NaN", "of 8", "transparent"});
    json transparent = with("/volume", "nan.nrrd");
    transparent["nan"] = "transparent";
    write("nan.json", transparent);
    EXPECT_EQ(render({"-o", folder / "nan.exr"}, "nan.json").exit_code, 0);
    EXPECT_NO_THROW(read_exr(folder / "nan.exr"));  // read_exr() refuses NaN
}

}  // namespace
}  // namespace lamina
