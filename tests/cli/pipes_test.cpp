// SPDX-License-Identifier: Apache-2.0
// lamina render with its scene from stdin and its picture to stdout.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>
#include <vector>

#include "cli/blobs_scene.h"
#include "cli/lamina_run.h"
#include "image/exr.h"
#include "image/npy.h"
#include "support/temporary_folder.h"

namespace lamina {
namespace {

class Pipes : public testing::Test {
  protected:
    void SetUp() override {
        write_bytes_to(folder / "scene.json", gaussians_scene(24, 40, 30, 60).dump());
    }

    // Runs lamina in the folder, with its file `input` as stdin.
    ProgramResult run(const std::vector<std::string>& arguments,
                      const std::string& input = "scene.json") {
        return lamina_run(arguments, [this, input] {
            if (chdir(folder.path().c_str()) != 0) _exit(126);
            dup2(open(input.c_str(), O_RDONLY), STDIN_FILENO);
        });
    }

    void expect_failure(int code, const std::vector<std::string>& arguments,
                        const std::vector<std::string>& parts) {
        const ProgramResult result = run(arguments, "bad.json");
        EXPECT_EQ(result.exit_code, code) << result.err;
        EXPECT_EQ(result.out, "");
        EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
        for (const std::string& part : parts)
            EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
    }

    TemporaryFolder folder;
};

TEST_F(Pipes, StdoutGetsTheBytesOfTheFile) {
    for (const std::string method : {"slice", "trace"}) {
        for (const std::string format : {"exr", "png", "npy"}) {
            const std::string file = folder / ("file." + format);
            ASSERT_EQ(run({"render", "scene.json", "-o", file, "--method", method}).exit_code, 0);
            const ProgramResult piped =
                run({"render", "-", "-o", "-", "--format", format, "--method", method});
            EXPECT_EQ(piped.exit_code, 0) << piped.err;
            EXPECT_EQ(piped.out, read_bytes_of(file)) << method << " " << format;
            EXPECT_NE(piped.err.find("wrote stdout"), std::string::npos) << piped.err;
        }
    }
}

// OpenEXR seeks in its output, which a pipe cannot.
TEST_F(Pipes, PipesOfAShellWork) {
    ASSERT_EQ(run({"render", "scene.json", "-o", "file.exr"}).exit_code, 0);
    const std::string command = std::string("cd ") + folder.path().string() +
                                " && cat scene.json | " + LAMINA_BINARY +
                                " render - -o - --format exr --quiet | cat > piped.exr";
    const ProgramResult result = run_program({"sh", "-c", command});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.err, "");
    EXPECT_EQ(read_bytes_of(folder / "piped.exr"), read_bytes_of(folder / "file.exr"));
    const std::string unread = std::string("cd ") + folder.path().string() + " && { " +
                               LAMINA_BINARY +
                               " render scene.json -o - --format exr; echo $? >&2; } | true";
    const ProgramResult closed = run_program({"sh", "-c", unread});
    EXPECT_NE(closed.err.find("stdout"), std::string::npos) << closed.err;
    EXPECT_NE(closed.err.find("\n1\n"), std::string::npos) << closed.err;
}

TEST_F(Pipes, ExplanationsGoToStderr) {
    const ProgramResult file = run({"render", "scene.json", "--explain"});
    const ProgramResult piped = run({"render", "-", "-o", "-", "--format", "npy", "--explain"});
    ASSERT_EQ(piped.exit_code, 0) << piped.err;
    EXPECT_NE(file.out, "");
    EXPECT_NE(piped.err.find(file.out), std::string::npos) << piped.err;
    EXPECT_EQ(piped.out.substr(1, 5), "NUMPY");
}

// "-" means stdout for every text output; no file of this name is written.
TEST_F(Pipes, TextsGoToStdout) {
    ASSERT_EQ(run({"generate", "gaussians", "-o", "g.nrrd", "--size", "8,8,8"}).exit_code, 0);
    ASSERT_EQ(run({"scene", "g.nrrd", "-o", "g.json"}).exit_code, 0);
    const ProgramResult scene = run({"scene", "g.nrrd", "-o", "-"});
    EXPECT_EQ(scene.exit_code, 0) << scene.err;
    // In a scene file, paths below the file are relative; on stdout they are absolute.
    std::string absolute = read_bytes_of(folder / "g.json");
    const std::string name = "\"g.nrrd\"";
    ASSERT_NE(absolute.find(name), std::string::npos);
    absolute.replace(absolute.find(name), name.size(), "\"" + (folder / "g.nrrd").string() + "\"");
    EXPECT_EQ(scene.out, absolute);
    EXPECT_EQ(scene.err.find("wrote"), std::string::npos) << scene.err;
    const ProgramResult stats =
        run({"render", "scene.json", "-o", "a.png", "--stats", "-", "--explain"});
    EXPECT_EQ(stats.exit_code, 0) << stats.err;
    EXPECT_TRUE(nlohmann::json::parse(stats.out).contains("frame_ms"));
    EXPECT_NE(stats.err.find("  method         slice\n"), std::string::npos) << stats.err;
    const ProgramResult profile = run({"render", "scene.json", "-o", "a.png", "--profile", "-"});
    EXPECT_EQ(profile.exit_code, 0) << profile.err;
    EXPECT_TRUE(nlohmann::json::parse(profile.out).contains("traceEvents"));
    write_bytes_to(folder / "cases.json",
                   R"([{"transfer_function": {"points": [{"value": 0, "extinction": 1}]},
                        "sf": 0, "sb": 0, "length": 1}])");
    const ProgramResult integral = run({"integrate", "cases.json", "-o", "-"});
    EXPECT_EQ(integral.exit_code, 0) << integral.err;
    EXPECT_EQ(integral.out, run({"integrate", "cases.json"}).out);
    EXPECT_FALSE(std::filesystem::exists(folder / "-"));
    // Two outputs to one stdout are refused.
    for (const std::vector<std::string>& both :
         {std::vector<std::string>{"-o", "-", "--format", "png", "--stats", "-"},
          {"-o", "a.png", "--profile", "-", "--stats", "-"}}) {
        std::vector<std::string> arguments{"render", "scene.json"};
        arguments.insert(arguments.end(), both.begin(), both.end());
        const ProgramResult result = run(arguments);
        EXPECT_EQ(result.exit_code, 2);
        EXPECT_EQ(result.out, "");
        EXPECT_NE(result.err.find("-, stdout: would be written twice"), std::string::npos)
            << result.err;
    }
}

// NPY has the numbers of the EXR file in float32; for the tracer, in double precision.
TEST_F(Pipes, NumpyFilesHaveTheNumbersOfExr) {
    ASSERT_EQ(run({"render", "scene.json", "-o", "a.exr"}).exit_code, 0);
    ASSERT_EQ(run({"render", "scene.json", "-o", "a.npy"}).exit_code, 0);
    const Image exr = read_exr(folder / "a.exr");
    const PreciseImage npy = read_npy(folder / "a.npy");
    ASSERT_EQ(npy.width, 40);
    ASSERT_EQ(npy.height, 30);
    for (std::size_t i = 0; i < npy.rgba.size(); ++i)
        ASSERT_EQ(npy.rgba[i], static_cast<double>(exr.rgba[i]));
    EXPECT_NE(read_bytes_of(folder / "a.npy").find("'<f4'"), std::string::npos);
    nlohmann::json projected = gaussians_scene(12, 40, 30, 60);
    projected["mesh"] = {{"tolerance", 0.2}};
    projected["render"]["method"] = "project";
    write_bytes_to(folder / "projected.json", projected.dump());
    ASSERT_EQ(run({"render", "projected.json", "-o", "p.npy"}).exit_code, 0);
    EXPECT_NE(read_bytes_of(folder / "p.npy").find("'<f4'"), std::string::npos);
    ASSERT_EQ(run({"render", "scene.json", "-o", "t.npy", "--method", "trace"}).exit_code, 0);
    EXPECT_NE(read_bytes_of(folder / "t.npy").find("'<f8'"), std::string::npos);
}

TEST_F(Pipes, PathsAreRelativeToTheCurrentFolder) {
    ASSERT_EQ(run({"generate", "gaussians", "-o", "g.nrrd", "--size", "8,8,8"}).exit_code, 0);
    nlohmann::json scene = gaussians_scene(24, 40, 30, 60);
    scene["volume"] = "g.nrrd";
    write_bytes_to(folder / "relative.json", scene.dump());
    EXPECT_EQ(run({"render", "-", "-o", "a.png"}, "relative.json").exit_code, 0);
    // A file that the scene reads is not replaced.
    const ProgramResult over =
        run({"render", "-", "-o", "a.png", "--stats", "g.nrrd"}, "relative.json");
    EXPECT_EQ(over.exit_code, 2);
    EXPECT_NE(over.err.find("g.nrrd"), std::string::npos) << over.err;
}

TEST_F(Pipes, MistakesAreReportedInOneLine) {
    write_bytes_to(folder / "bad.json", "{\"version\": 1,\n nonsense}");
    expect_failure(1, {"render", "-", "-o", "-", "--format", "png"}, {"stdin", "line 2"});
    write_bytes_to(folder / "bad.json", "{\"version\": 1, \"volume\": \"absent.nrrd\"}");
    expect_failure(1, {"render", "-", "-o", "-", "--format", "png"}, {"absent.nrrd"});
    write_bytes_to(folder / "bad.json", "");
    expect_failure(1, {"render", "-", "-o", "-", "--format", "png"}, {"stdin"});
    expect_failure(2, {"render", "-", "-o", "-"}, {"--format"});
    expect_failure(2, {"render", "-", "-o", "-", "--format", "jpeg"}, {"jpeg", "png"});
    expect_failure(2, {"render", "-", "-o", "a.png", "--format", "png"}, {"--format png", "-o -"});
    expect_failure(2, {"render", "-", "--explain", "--format", "png"}, {"--format"});
    EXPECT_FALSE(std::filesystem::exists(folder / "a.png"));
}

}  // namespace
}  // namespace lamina
