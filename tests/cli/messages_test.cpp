// SPDX-License-Identifier: Apache-2.0
// Messages of the program about files with any names and contents: safe to print on a terminal.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cli/blobs_scene.h"
#include "cli/lamina_run.h"
#include "support/temporary_folder.h"

namespace lamina {
namespace {

using nlohmann::json;

// A name with an escape sequence for red, a line end, and a byte that is not UTF-8; and the text
// that messages show for it.
const std::string hostile = "a\x1b[31m\nb\xff";
const std::string escaped = "a\\x1b[31m\\nb\\xff";

class Messages : public testing::Test {
  protected:
    // Expects one line of printable ASCII with these parts.
    void expect_line(const std::string& err, std::initializer_list<std::string> parts) {
        EXPECT_EQ(std::ranges::count(err, '\n'), 1) << err;
        EXPECT_TRUE(std::ranges::all_of(err, [](char c) {
            return c == '\n' || (c >= ' ' && c <= '~');
        })) << err;
        for (const std::string& part : parts)
            EXPECT_NE(err.find(part), std::string::npos) << part << " is not in " << err;
    }

    // Writes a scene of a volume of 4^3 samples of type uint8, all 1, followed by `surplus`.
    std::string scene_with(const std::string& surplus) {
        write_bytes_to(folder / "v.nrrd",
                       "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 4 4 4\nspacings: 1 1 1\n"
                       "encoding: raw\n\n" +
                           std::string(64, '\1') + surplus);
        json scene = gaussians_scene(4, 8, 6, 4);
        scene["volume"] = "v.nrrd";
        write_bytes_to(folder / "scene.json", scene.dump());
        return folder / "scene.json";
    }

    TemporaryFolder folder;
};

TEST_F(Messages, NamesAreEscaped) {
    for (const char* const verb : {"render", "study", "mesh", "crosscheck"}) {
        const std::string output = std::string(verb) == "render" ? "out.exr" : "out.vtu";
        const ProgramResult result =
            lamina_run({verb, folder / (hostile + ".json"), "-o", folder / output});
        EXPECT_NE(result.exit_code, 0);
        expect_line(result.err, {escaped + ".json: no such file"});
    }
    const ProgramResult missing = lamina_run({"info", folder / (hostile + ".nrrd")});
    EXPECT_EQ(missing.exit_code, 1);
    expect_line(missing.err, {escaped + ".nrrd: no such file"});
    expect_line(lamina_run({"info", "--" + hostile}).err, {"lamina: "});
    expect_line(lamina_run({hostile}).err, {escaped + ": unknown verb"});
}

TEST_F(Messages, NamesOfWhatIsWrittenAreEscaped) {
    const std::filesystem::path home = folder / hostile;
    std::filesystem::create_directory(home);
    write_bytes_to(home / "scene.json", blobs_scene(8, 6, 4).dump());
    const ProgramResult result =
        lamina_run({"render", home / "scene.json", "-o", home / "a.exr", "--stats", home / "s.json",
                    "--profile", home / "p.json", "--explain"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    expect_line(result.err, {"wrote ", escaped + "/a.exr"});
    for (const char* const file : {"s.json", "p.json"})
        EXPECT_TRUE(json::accept(read_bytes_of(home / file))) << file;
}

TEST_F(Messages, StudiesAndCrosschecksMayHaveAnyName) {
    const std::filesystem::path home = folder / hostile;
    std::filesystem::create_directory(home);
    write_bytes_to(home / "scene.json", blobs_scene(8, 6, 4).dump());
    write_bytes_to(home / "study.json",
                   R"({"version": 1, "scenes": ["scene.json"], "rounds": 1,
                       "sweep": [{"render.slice.samples": [2, 4]}]})");
    const ProgramResult study =
        lamina_run({"study", home / "study.json", "-o", home / "out", "--yes", "--quiet"});
    EXPECT_EQ(study.exit_code, 0) << study.err;
    EXPECT_TRUE(json::accept(read_bytes_of(home / "out" / "results.json")));
    const ProgramResult check = lamina_run(
        {"crosscheck", home / "scene.json", "-o", home / "check", "--quiet", "--context", "cpu"});
    EXPECT_EQ(check.exit_code, 0) << check.err;
    EXPECT_TRUE(json::accept(read_bytes_of(home / "check" / "budget.json")));
}

// Names of a mesh's arrays are escaped, too.
TEST_F(Messages, NamesInFilesAreEscaped) {
    write_bytes_to(
        folder / "a.vtk",
        "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\n"
        "POINTS 4 float\n0 0 0 1 0 0 0 1 0 0 0 1\nCELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n"
        "10\nPOINT_DATA 4\nSCALARS a\x1b[31m\xff float\nLOOKUP_TABLE default\n1 2 3 4\n");
    const ProgramResult table = lamina_run({"info", folder / "a.vtk"});
    EXPECT_EQ(table.exit_code, 0) << table.err;
    EXPECT_EQ(table.out.find('\x1b'), std::string::npos) << table.out;
    EXPECT_EQ(table.out.find('\xff'), std::string::npos) << table.out;
    const ProgramResult report = lamina_run({"info", folder / "a.vtk", "--json"});
    EXPECT_TRUE(json::accept(report.out)) << report.out;
    const ProgramResult order = lamina_run({"order", folder / "a.vtk", "--json"});
    EXPECT_TRUE(json::accept(order.out)) << order.out << order.err;
}

TEST_F(Messages, DataThatAreNotUsedAreReportedOnce) {
    const std::string scene = scene_with("xyz");
    const std::vector<std::string> render = {"render",         scene,       "-o",
                                             folder / "a.exr", "--context", "cpu"};
    const ProgramResult result = lamina_run(render);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const std::string warning =
        "v.nrrd: found 3 bytes more than the 4 x 4 x 4 uint8 samples of the header: they are not "
        "used\n";
    const std::size_t at = result.err.find(warning);
    ASSERT_NE(at, std::string::npos) << result.err;
    EXPECT_TRUE(result.err.starts_with("lamina: warning: ")) << result.err;
    EXPECT_EQ(result.err.find(warning, at + 1), std::string::npos) << result.err;
    EXPECT_TRUE(std::filesystem::exists(folder / "a.exr"));

    std::vector<std::string> quiet = render;
    quiet.emplace_back("--quiet");
    EXPECT_EQ(lamina_run(quiet).err, "");
    EXPECT_NE(lamina_run({"info", folder / "v.nrrd"}).err.find(warning), std::string::npos);
    scene_with("");
    EXPECT_EQ(lamina_run(render).err.find("warning"), std::string::npos);
}

// The program warns, as without a tree, and does not refuse the scene.
TEST_F(Messages, AnAutomaticTreeIsNoReasonToRefuseFloat32) {
    json scene = gaussians_scene(12, 40, 30, 4);
    scene["render"] = {{"max_error", 1e-5}, {"slice", {{"tree", "auto"}}}};
    write_bytes_to(folder / "scene.json", scene.dump());
    for (const char* const samples : {"auto", "1000"}) {
        const ProgramResult result =
            lamina_run({"render", folder / "scene.json", "-o", folder / "a.exr", "--context", "cpu",
                        "--set", std::string("render.slice.samples=") + samples});
        EXPECT_EQ(result.exit_code, 0) << result.err;
        EXPECT_NE(result.err.find("lamina: warning: render.max_error: 1e-05 is not kept: "),
                  std::string::npos)
            << result.err;
    }
}

// A mesh that is made from the volume has no file, so messages name the scene.
TEST_F(Messages, AMeshMadeFromAVolumeIsNamedByItsScene) {
    json scene = gaussians_scene(4, 8, 6, 4);
    scene["volume"] = "v.nrrd";
    scene["mesh"] = {{"kuhn", true}};
    write_bytes_to(folder / "scene.json", scene.dump());
    const auto expect_of = [&](const std::string& volume, const std::string& message) {
        write_bytes_to(folder / "v.nrrd", "NRRD0004\ndimension: 3\nsizes: 2 2 2\n" + volume);
        const ProgramResult result = lamina_run(
            {"render", folder / "scene.json", "-o", folder / "a.exr", "--method", "project"});
        EXPECT_EQ(result.exit_code, 1);
        expect_line(result.err, {"scene.json: mesh: " + message});
    };
    expect_of("type: uint8\nspacings: 1e70 1e70 1e70\nencoding: raw\n\n01234567",
              "the diagonal of the mesh is ");
    expect_of("type: float\nencoding: ascii\n\n1 2 3 4 5 6 7 nan\n",
              "1 of 8 samples are NaN or infinite");
}

// Exact segments keep .05 / 255 for colours up to 1; here colours go up to 900.
TEST_F(Messages, BrightColorsWhoseErrorIsTooLargeAreReported) {
    json scene = gaussians_scene(12, 40, 30, 4);
    write_bytes_to(folder / "scene.json", scene.dump());
    const std::vector<std::string> render = {"render",         folder / "scene.json", "-o",
                                             folder / "a.exr", "--context",           "cpu"};
    EXPECT_EQ(lamina_run(render).err.find("is not kept"), std::string::npos);
    for (json& point : scene["transfer_function"]["points"]) point["color"] = {900, 1, 1};
    write_bytes_to(folder / "scene.json", scene.dump());
    const ProgramResult result = lamina_run(render);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.err.find("render.max_error: 1 is not kept: exact segments in float32 are off "
                              "by up to 45 / 255, in proportion to the brightest colour"),
              std::string::npos)
        << result.err;
}

// File systems allow no name of more than 255 bytes and no path of more than 4096.
TEST_F(Messages, PathsThatAreTooLongGetOneShortLine) {
    const std::string scene = scene_with("");
    std::string deep = folder.path();
    for (int i = 0; i < 50; ++i) deep += "/" + std::string(100, 'd');
    const std::string longest(100'000, 'x');  // Linux passes no argument of 128 KiB
    const std::vector<std::string> paths{folder / std::string(300, 'n'), deep, longest};
    for (const std::string& path : paths) {
        for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
                 {"render", path, "-o", folder / "a.exr"},
                 {"render", scene, "-o", path + ".exr"},
                 {"render", scene, "-o", folder / "a.exr", "--stats", path},
                 {"render", scene, "-o", folder / "a.exr", "--set", "volume=" + path},
                 {"render", scene, "-o", folder / "a.exr", "--set", "render.target=" + path},
                 {"info", path},
                 {"scene", path, "-o", folder / "b.json"},
                 {"scene", scene, "-o", path},
                 {"index", path},
                 {"mesh", path, "-o", folder / "a.vtu"},
                 {"order", path},
                 {"compare", path, path},
                 {"study", path, "-o", folder / "study"},
                 {"crosscheck", path, "-o", folder / "check"},
                 {"reproduce", "lamar", "table3", "-o", path},
                 {path}}) {
            std::vector<std::string> shown = arguments;
            for (std::string& word : shown) word = word.substr(0, 20);
            if (path == longest) shown.emplace_back("(longest)");
            const ProgramResult result = lamina_run(arguments);
            EXPECT_TRUE(result.exit_code == 1 || result.exit_code == 2)
                << json(shown) << result.exit_code;
            expect_line(result.err, {"lamina: "});
            EXPECT_LT(result.err.size(), 3000u) << json(shown);
            for (const char* const library : {"json.exception", "std::", "filesystem error"})
                EXPECT_EQ(result.err.find(library), std::string::npos) << result.err;
            EXPECT_EQ(result.err.find("a mistake of lamina"), std::string::npos) << json(shown);
            EXPECT_FALSE(std::filesystem::exists(folder / "a.exr")) << json(shown);
        }
    }
}

TEST_F(Messages, ASceneThatIsNoObjectIsNamedBeforeItsKeysAreSet) {
    for (const char* const document : {"[]", "[1]", "3", "null", "\"x\""}) {
        write_bytes_to(folder / "list.json", document);
        const ProgramResult result =
            lamina_run({"render", folder / "list.json", "-o", folder / "a.exr", "--set",
                        "volume.channel=1", "--set", "render.target=fixed8"});
        EXPECT_EQ(result.exit_code, 1);
        expect_line(result.err,
                    {"list.json: found " + std::string(document), "expected an object"});
    }
}

// JSON would change the name, so the scene would name another file.
TEST_F(Messages, AScenesDataHaveNamesThatJsonCanHold) {
    scene_with("");
    const std::filesystem::path odd = folder / "b\xff.nrrd";
    std::filesystem::rename(folder / "v.nrrd", odd);
    const ProgramResult result = lamina_run({"scene", odd, "-o", folder / "new.json"});
    EXPECT_EQ(result.exit_code, 1);
    expect_line(result.err, {"b\\xff.nrrd: its name is not UTF-8", "expected another name"});
    EXPECT_FALSE(std::filesystem::exists(folder / "new.json"));
}

}  // namespace
}  // namespace lamina
