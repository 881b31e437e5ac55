// SPDX-License-Identifier: Apache-2.0
// Machines that lack libraries, drivers or folders, and unusual environments.
#include <sys/stat.h>

#include <clocale>
#include <cstdlib>

#include "cli/faults_test_case.h"

namespace lamina {
namespace {

class FaultsOfMachines : public FaultsTestCase {
  protected:
    std::vector<std::string> drawing_by(const std::string& context) const {
        return {"render", folder / "scene.json", "-o", out / "a.exr", "--context", context};
    }
    static std::function<void()> with(const char* name, const std::string& value) {
        return [=] { setenv(name, value.c_str(), 1); };
    }
};

TEST_F(FaultsOfMachines, MissingOpenGLLibrariesAreNamed) {
    for (const char* name : {"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so", "libEGL.so.1"})
        write_bytes_to(folder / name, "no library");
    const auto broken = with("LD_LIBRARY_PATH", folder.path().string());
    expect_one_line(lamina_run(drawing_by("osmesa"), broken), 1,
                    {"OSMesa", "libOSMesa.so.8", "install"});
    expect_one_line(lamina_run(drawing_by("egl"), broken), 1, {"EGL", "libEGL.so.1", "install"});
    EXPECT_TRUE(contents(out).empty());
    EXPECT_EQ(lamina_run(drawing_by("auto"), broken).exit_code, 0);  // takes the cpu engine
}

TEST_F(FaultsOfMachines, AMissingEGLDeviceIsReported) {
    expect_one_line(
        lamina_run(drawing_by("egl"), with("__EGL_VENDOR_LIBRARY_FILENAMES", "/dev/null")), 1,
        {"EGL", "install"});
    EXPECT_TRUE(contents(out).empty());
}

// With an unknown driver OSMesa itself would crash.
TEST_F(FaultsOfMachines, AnUnknownDriverIsNamed) {
    expect_one_line(lamina_run(drawing_by("osmesa"), with("GALLIUM_DRIVER", "abacus")), 1,
                    {"GALLIUM_DRIVER", "abacus", "llvmpipe"});
}

TEST_F(FaultsOfMachines, ShadersThatDoNotCompileAreNamedWithTheLine) {
    const auto shaders = folder.path() / "shaders";
    std::filesystem::create_directories(shaders / "gl");
    write_bytes_to(shaders / "gl" / "full_screen.vert", "#version 450 core\n\nvoid main() { x }\n");
    for (const char* context : {"osmesa", "egl"})
        expect_one_line(lamina_run(drawing_by(context), with("LAMINA_SHADER_DIR", shaders)), 1,
                        {"gl/full_screen.vert:3"});
    expect_one_line(lamina_run(drawing_by("osmesa"), with("LAMINA_SHADER_DIR", folder / "absent")),
                    1, {"absent", "LAMINA_SHADER_DIR"});
}

// Copies the program and puts `script` beside it as lamina-tetrahedralize.
TEST_F(FaultsOfMachines, FailingTetrahedralizersAreReported) {
    const std::string program = folder / "lamina", tool = folder / "lamina-tetrahedralize";
    std::filesystem::copy_file(LAMINA_BINARY, program);
    const auto mesh = [&](const std::string& script) {
        if (!script.empty()) {
            write_bytes_to(tool, script);
            std::filesystem::permissions(tool, std::filesystem::perms::owner_all);
        }
        return run_program({program, "mesh", folder / "volume.nrrd", "-o", out / "a.vtu",
                            "--tolerance", ".1", "--quiet"},
                           with("PATH", "/usr/bin:/bin"));
    };
    const std::string volume = "volume.nrrd: ";
    expect_one_line(mesh(""), 1, {volume, "lamina-tetrahedralize", "--kuhn"});
    expect_one_line(mesh("no program"), 1, {volume, "cannot be started"});
    expect_one_line(mesh("#!/bin/sh\nkill -9 $$\n"), 1, {volume, "ended by signal 9"});
    expect_one_line(mesh("#!/bin/sh\nexit 0\n"), 1, {volume, "gave no answer"});
    expect_one_line(mesh("#!/bin/sh\nhead -c 5000 /dev/zero | tr '\\0' x\n"), 1,
                    {volume, "promised"});
    // Answers with one tet whose corners are all the first point.
    expect_one_line(mesh("#!/bin/sh\nprintf '\\001'; head -c 39 /dev/zero\n"), 1,
                    {volume, "do not fill the box"});
    EXPECT_TRUE(contents(out).empty());
}

TEST_F(FaultsOfMachines, DecimalCommasChangeNothing) {
    const char* const german = "de_DE.UTF-8";
    const bool there = std::setlocale(LC_ALL, german) != nullptr;
    std::setlocale(LC_ALL, "C");
    if (!there) GTEST_SKIP() << "no locale " << german;
    const auto run_all = [&](const char* locale) {
        std::string printed;
        const auto run = [&](const std::vector<std::string>& arguments) {
            const ProgramResult result = lamina_run(arguments, with("LC_ALL", locale));
            EXPECT_EQ(result.exit_code, 0) << result.err;
            printed += result.out;
        };
        run({"generate", "marschner-lobb", "-o", out / "a.nrrd", "--size", "16,16,16", "--type",
             "float"});
        run({"info", out / "a.nrrd"});
        run({"mesh", out / "a.nrrd", "-o", out / "a.vtu", "--kuhn"});
        run({"mesh", out / "a.nrrd", "-o", out / "a.node", "--kuhn"});
        run({"info", out / "a.node", "--json"});
        run(rendering(out / "a.exr", {"--explain", "--set", "render.max_error=0.5"}));
        run({"render", folder / "scene.json", "-o", out / "b.exr", "--context", "osmesa"});
        run({"compare", out / "a.exr", out / "b.exr", "--json", "--max-linf", "254.5"});
        run({"integrate", folder / "segments.json"});
        return std::pair(printed, contents(out));
    };
    const auto in_c = run_all("C"), in_german = run_all(german);
    EXPECT_EQ(in_c.first, in_german.first);
    EXPECT_TRUE(in_c.second == in_german.second);
    expect_one_line(lamina_run(rendering(out / "a.exr", {"--set", "render.max_error=0,5"}),
                               with("LC_ALL", german)),
                    2, {"render.max_error", "0,5"});
}

TEST_F(FaultsOfMachines, OddFileNamesWork) {
    make(rendering(folder / "a.exr"));
    const std::string expected = read_bytes_of(folder / "a.exr");
    for (const std::string& name :
         {std::string("with space.exr"), std::string("ü☃.exr"), std::string("\xff.exr"),
          std::string("two\nlines.exr"), std::string("-x.exr"), std::string(251, 'n') + ".exr"}) {
        for (int twice = 0; twice < 2; ++twice) {  // the second time it replaces the file
            make(rendering(out / name));
            EXPECT_EQ(read_bytes_of(out / name), expected) << name;
        }
        std::filesystem::copy_file(folder / "scene.json", out / (name.substr(0, 240) + ".json"));
        std::vector<std::string> arguments = rendering(out / name);
        arguments[1] = out / (name.substr(0, 240) + ".json");
        // The volume is not beside this copy of the scene.
        expect_one_line(lamina_run(arguments), 1, {"volume.nrrd"});
        std::filesystem::remove_all(out);
        std::filesystem::create_directory(out);
    }
    expect_one_line(lamina_run(rendering(out / (std::string(252, 'n') + ".exr"))), 1, {"too long"});
    const auto in_out = [&] {
        if (chdir(out.c_str()) != 0) _exit(126);
    };
    EXPECT_EQ(lamina_run(rendering("-x.exr"), in_out).exit_code, 0);
    EXPECT_EQ(read_bytes_of(out / "-x.exr"), expected);
}

// Nobody writes into these pipes: opening one would block forever.
TEST_F(FaultsOfMachines, PipesInPlaceOfFilesAreRefused) {
    const auto pipe_called = [&](const std::string& name) {
        const std::string path = folder / name;
        EXPECT_EQ(mkfifo(path.c_str(), 0600), 0) << name;
        return path;
    };
    for (const char* name : {"a.nrrd", "a.nhdr", "a.vtu", "a.vtk", "a.h5", "a.hdf5", "a.nc",
                             "a.mha", "a.nii", "a.tif", "a.dcm", "a.vti"}) {
        const std::string path = pipe_called(name);
        expect_one_line(lamina_run({"info", path}), 1, {path, "not a regular file"});
    }
    for (const char* name : {"a.exr", "a.png", "a.npy"}) {
        const std::string path = pipe_called(name);
        expect_one_line(lamina_run({"compare", path, path}), 1, {path, "not a regular file"});
    }
    const std::string pipe = pipe_called("a.json");
    const std::string picture = out / "a.exr";
    for (const char* verb : {"render", "study", "crosscheck"})
        expect_one_line(lamina_run({verb, pipe, "-o", picture}), 1, {pipe, "not a file"});
    expect_one_line(lamina_run({"integrate", pipe}), 1, {pipe, "not a file"});
    expect_one_line(lamina_run(rendering(picture, {"--set", "transfer_function.colormap=a.json"})),
                    1, {pipe, "not a file"});
    expect_one_line(lamina_run(rendering(picture, {"--set", "volume=a.nrrd"})), 1, {"a.nrrd"});
    write_bytes_to(folder / "b.nhdr",
                   "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 4 4 4\nencoding: raw\n"
                   "data file: " +
                       pipe_called("a.raw") + "\n\n");
    expect_one_line(lamina_run({"info", folder / "b.nhdr"}), 1, {"a.raw", "not a regular file"});
    EXPECT_TRUE(contents(out).empty());
}

// A pipe with the name of the volume's index, beside the volume: the index is made without it.
TEST_F(FaultsOfMachines, PipesInPlaceOfAnIndexAreNotUsed) {
    // Stays in its file if memory is limited to 1M.
    const std::string volume = folder / "large.nrrd";
    make({"generate", "gaussians", "-o", volume, "--size", "128,128,128"});
    const std::string index = volume + ".lamina-index";
    ASSERT_EQ(mkfifo(index.c_str(), 0600), 0);
    const auto with_cache = [&] { setenv("XDG_CACHE_HOME", (folder / "cache").c_str(), 1); };
    const ProgramResult drawn = lamina_run({"render", volume, "-o", out / "a.exr", "--context",
                                            "cpu", "--size", "20x15", "--memory", "1M"},
                                           with_cache);
    EXPECT_EQ(drawn.exit_code, 0) << drawn.err;
    EXPECT_NE(drawn.err.find("the index is not a regular file"), std::string::npos) << drawn.err;
    expect_one_line(lamina_run({"index", volume}, with_cache), 1, {index, "found another file"});
}

TEST_F(FaultsOfMachines, MissingFoldersAreReportedOnlyIfNeeded) {
    const auto lost = [&] {
        unsetenv("HOME");
        setenv("TMPDIR", "/absent", 1);
        if (chdir(out.c_str()) != 0 || rmdir(out.c_str()) != 0) _exit(126);
    };
    EXPECT_EQ(lamina_run(rendering(folder / "a.exr"), lost).exit_code, 0);
    std::filesystem::create_directory(out);
    expect_one_line(lamina_run(rendering("a.exr"), lost), 1, {"a.exr", "No such file"});
    std::filesystem::create_directory(out);
    expect_one_line(lamina_run({"info", "volume.nrrd"}, lost), 1, {"volume.nrrd"});
}

}  // namespace
}  // namespace lamina
