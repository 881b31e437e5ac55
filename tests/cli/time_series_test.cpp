// SPDX-License-Identifier: Apache-2.0
// lamina render --time.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "cli/lamina_run.h"
#include "image/exr.h"
#include "support/mesh_makers.h"
#include "support/temporary_folder.h"

namespace lamina {
namespace {

using nlohmann::json;

// Returns 9 x 8 x 7 samples of a blob whose largest value is 40 (step + 1).
std::string blob(int step) {
    std::string samples;
    for (int i = 0; i < 9 * 8 * 7; ++i) {
        const int x = i % 9 - 4, y = i / 9 % 8 - 4, z = i / 72 - 3;
        samples += static_cast<char>(40 * (step + 1) * 10 / (10 + x * x + y * y + z * z));
    }
    return samples;
}

std::string nrrd_of(const std::string& samples) {
    return "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 9 8 7\nencoding: raw\n\n" + samples;
}

class TimeSeriesRun : public ::testing::Test {
  protected:
    void SetUp() override {
        for (int step = 0; step < 4; ++step)
            write("v_0" + std::to_string(step) + ".nrrd", nrrd_of(blob(step)));
        write_scene({{"volume", "v_%02d.nrrd"}});
    }

    void write(const std::string& name, const std::string& bytes) {
        write_bytes_to(folder / name, bytes);
    }
    // Writes a scene of 30 x 20 pixels; unless `open`, with a camera and a transfer function.
    void write_scene(json data, bool open = false) {
        data["version"] = 1;
        data["image"] = {{"width", 30}, {"height", 20}};
        if (!open) {
            data["camera"] = {{"eye", {20, 5, 6}}, {"center", {4, 3.5, 3}}};
            data["transfer_function"] = json::parse(
                R"({"points": [{"value": 0, "extinction": 0}, {"value": 160, "extinction": 1}]})");
        }
        write("scene.json", data.dump());
    }

    ProgramResult run(const std::string& scene, const std::string& time,
                      const std::vector<std::string>& more = {}) {
        std::vector<std::string> arguments{
            "render", folder / scene, "-o", folder / "out/p_%02d.exr", "--time", time};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return lamina_run(arguments);
    }
    std::string run_well(const std::string& scene, const std::string& time, const std::string& says,
                         const std::vector<std::string>& more = {}) {
        const ProgramResult result = run(scene, time, more);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        EXPECT_NE(result.err.find(says), std::string::npos) << result.err;
        return result.err;
    }
    void expect_bad(const std::string& scene, const std::string& time, int exit_code,
                    const std::vector<std::string>& says) {
        const ProgramResult result = run(scene, time);
        EXPECT_EQ(result.exit_code, exit_code) << result.err;
        for (const std::string& part : says)
            EXPECT_NE(result.err.find(part), std::string::npos) << part << "\n" << result.err;
        EXPECT_FALSE(std::filesystem::exists(folder / "out"));
    }
    std::vector<float> picture(const std::string& name) {
        return read_exr(std::string(folder / name)).rgba;
    }
    // Returns the picture that `lamina render` makes of the scene with these settings.
    std::vector<float> single(const std::vector<std::string>& settings) {
        std::vector<std::string> arguments{"render", folder / "scene.json", "-o",
                                           folder / "one.exr"};
        for (const std::string& setting : settings)
            arguments.insert(arguments.end(), {"--set", setting});
        const ProgramResult result = lamina_run(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return picture("one.exr");
    }

    TemporaryFolder folder;
};

TEST_F(TimeSeriesRun, EachStepIsThePictureOfItsFile) {
    for (const std::string method : {"slice", "trace"}) {
        run_well("scene.json", "1:3:2", "wrote 2 of 2 steps as", {"--method", method});
        EXPECT_FALSE(std::filesystem::exists(folder / "out/p_02.exr"));
        for (const std::string step : {"1", "3"}) {
            EXPECT_EQ(picture("out/p_0" + step + ".exr"),
                      single({"volume=v_0" + step + ".nrrd", "render.method=" + method}));
        }
        EXPECT_NE(picture("out/p_01.exr"), picture("out/p_03.exr"));
    }
}

// The choices for the first step are kept: choices for a later step would make it brighter.
TEST_F(TimeSeriesRun, AllStepsUseTheChoicesOfTheFirst) {
    const std::string said = run_well("v_%02d.nrrd", "0:2", "those of step 0", {"--size", "30x20"});
    EXPECT_NE(said.find("wrote 3 of 3"), std::string::npos) << said;
    write_scene({{"volume", "v_00.nrrd"}, {"nan", "transparent"}, {"lighting", "auto"}}, true);
    EXPECT_EQ(picture("out/p_00.exr"), single({}));
    EXPECT_NE(picture("out/p_02.exr"), single({"volume=v_02.nrrd"}));
    // The attributes of each file have the scene of its own step.
    const std::string bytes = read_bytes_of(folder / "out/p_02.exr");
    EXPECT_NE(bytes.find("v_02.nrrd"), std::string::npos);
}

TEST_F(TimeSeriesRun, FinishedStepsAreKept) {
    run_well("scene.json", "0:2", "wrote 3 of 3");
    const auto before = picture("out/p_01.exr");
    run_well("scene.json", "0:3", "wrote 1 of 4 steps");
    run_well("scene.json", "0:3", "4 were there and are kept");
    write("v_01.nrrd", nrrd_of(blob(3)));
    run_well("scene.json", "0:3", "wrote 1 of 4 steps");
    EXPECT_NE(picture("out/p_01.exr"), before);
    write_bytes_to(folder / "out/p_02.exr", "damaged");
    run_well("scene.json", "0:3", "wrote 1 of 4 steps");
    run_well("scene.json", "0:3", "wrote 4 of 4 steps", {"--force"});
    run_well("scene.json", "0:3", "wrote 4 of 4 steps", {"--set", "render.max_error=2"});
}

TEST_F(TimeSeriesRun, NothingIsDrawnWhereAStepIsMissing) {
    expect_bad("scene.json", "2:5", 1, {"v_04.nrrd", "step 4", "not there", "2 to 5"});
    expect_bad("v_%02d.nrrd", "3:9", 1, {"v_04.nrrd"});
    write_scene({{"volume", "v_%02d_%d.nrrd"}});
    expect_bad("scene.json", "0:1", 2, {"v_%02d_%d.nrrd", "one number"});
    write_scene({{"volume", "v_00.nrrd"}});
    expect_bad("scene.json", "0:1", 1, {"v_00.nrrd", "time"});
    write_scene({{"volume", {{"generate", "mixing"}}}});
    expect_bad("scene.json", "0:1", 2, {"generated"});
    expect_bad("scene_%d.json", "0:1", 2, {"scene"});
}

TEST_F(TimeSeriesRun, MistakesOfUsageExitWith2) {
    for (const char* const time : {"3", "3:1", "0:4:0", "a:b", "-1:2", "0:2:1:1", "0:2:", ""})
        EXPECT_EQ(run("scene.json", time).exit_code, 2) << time;
    EXPECT_EQ(run("scene.json", "0:1", {"--frames", "2"}).exit_code, 2);
    EXPECT_EQ(run("scene.json", "0:999999").exit_code, 2);
    const ProgramResult one =
        lamina_run({"render", folder / "scene.json", "-o", folder / "a.png", "--time", "1"});
    EXPECT_EQ(one.exit_code, 2);
    EXPECT_NE(one.err.find("--set volume.time=1 (of a mesh mesh.time) draws one step"),
              std::string::npos)
        << one.err;
    EXPECT_EQ(lamina_run({"render", folder / "scene.json", "-o", folder / "a.png", "--time", "0:1"})
                  .exit_code,
              2);
}

TEST_F(TimeSeriesRun, AnotherGridGivesAWarning) {
    write("v_01.nrrd",
          "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 9 8 7\nspacings: 1 1 2\nencoding: raw\n\n" +
              blob(1));
    run_well("scene.json", "0:1", "step 1: its grid is not that of step 0");
}

TEST_F(TimeSeriesRun, StepsAreReadFromTheTimeAxisOfAFile) {
    write("4d.nrrd",
          "NRRD0004\ntype: uint8\ndimension: 4\nsizes: 9 8 7 3\nkinds: domain domain domain "
          "time\nencoding: raw\n\n" +
              blob(0) + blob(1) + blob(2));
    write_scene({{"volume", "4d.nrrd"}});
    run_well("scene.json", "0:2:2", "wrote 2 of 2");
    EXPECT_EQ(picture("out/p_02.exr"), single({"volume=v_02.nrrd"}));
    std::filesystem::remove_all(folder / "out");
    expect_bad("scene.json", "1:3", 1, {"4d.nrrd", "time", "found 3", "0 to 2"});
    // A series may begin with a later step.
    const std::string said = run_well("scene.json", "1:2", "wrote 2 of 2");
    EXPECT_EQ(said.find("time 0"), std::string::npos) << said;
    EXPECT_EQ(picture("out/p_01.exr"), single({"volume=v_01.nrrd"}));
    EXPECT_EQ(picture("out/p_02.exr"), single({"volume=v_02.nrrd"}));
}

TEST_F(TimeSeriesRun, MeshesAreReadFromFilesAndFromAPvd) {
    std::string pvd = "<VTKFile type=\"Collection\"><Collection>";
    for (int step = 0; step < 3; ++step) {
        testing::TestGrid grid;
        grid.points = {{0, 0, 0}, {3, 0, 0}, {0, 3, 0}, {0, 0, 3}};
        grid.cells = {{10, {0, 1, 2, 3}}};
        grid.point_arrays = {{"s", "Float32", 1, {0, 40.0 * (step + 1), 10, 20}}};
        const std::string name = "m_" + std::to_string(step) + ".vtu";
        write(name, testing::make_vtu(grid));
        pvd += "<DataSet timestep=\"" + std::to_string(step * .5) + "\" file=\"" + name + "\"/>";
    }
    write("m.pvd", pvd + "</Collection></VTKFile>");
    for (const char* const mesh : {"m_%d.vtu", "m.pvd"}) {
        write_scene({{"mesh", mesh}});
        run_well("scene.json", "0:2:2", "wrote 2 of 2 steps", {"--force"});
        EXPECT_EQ(picture("out/p_02.exr"), single({"mesh=m_2.vtu"})) << mesh;
    }
    EXPECT_EQ(picture("out/p_02.exr"), single({R"(mesh={"path": "m.pvd", "time": 2})"}));
    std::filesystem::remove_all(folder / "out");
    expect_bad("scene.json", "0:3", 1, {"m.pvd", "step 3", "0 to 2"});
}

}  // namespace
}  // namespace lamina
