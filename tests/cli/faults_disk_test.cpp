// SPDX-License-Identifier: Apache-2.0
// Full disks, and files that cannot be written.
#include <sys/resource.h>

#include <set>

#include "cli/faults_test_case.h"

namespace lamina {
namespace {

// Limit of file sizes in bytes, which simulates a full disk. Messages to stderr are shorter, and
// all outputs in this file are longer.
constexpr rlim_t room = 1000;

void fill_the_disk() {
    const rlimit limit{room, room};
    setrlimit(RLIMIT_FSIZE, &limit);
}

class FaultsOfDisks : public FaultsTestCase {
  protected:
    // Expects that the files `names` in the folder `out`, which `arguments` write, keep their old
    // contents if the disk is full.
    void expect_old_files_survive(const std::vector<std::string>& arguments,
                                  const std::vector<std::string>& names) {
        SCOPED_TRACE(arguments[0] + " " + names[0]);
        make(arguments);
        for (const std::string& name : names) {
            ASSERT_GT(std::filesystem::file_size(out / name), room) << name;
            write_bytes_to(out / name, "old " + name);
        }
        const auto before = contents(out);
        EXPECT_EQ(before.size(), names.size());
        expect_one_line(lamina_run(arguments, fill_the_disk), 1, {"cannot write", "too large"});
        EXPECT_EQ(contents(out), before);
        for (const std::string& name : names) std::filesystem::remove(out / name);
    }
};

TEST_F(FaultsOfDisks, FullDisksLeaveOldFilesAsTheyAre) {
    const std::string volume = folder / "volume.nrrd";
    make(rendering(folder / "a.png"));
    make(rendering(folder / "b.png", {"--set", "render.slice.samples=7", "--set",
                                      "render.slice.classification=post"}));
    make({"mesh", volume, "-o", folder / "mesh.vtu", "--kuhn"});
    expect_old_files_survive(rendering(out / "a.exr"), {"a.exr"});
    expect_old_files_survive(rendering(out / "a.png"), {"a.png"});
    expect_old_files_survive(rendering(out / "a.npy", {"--method", "trace"}), {"a.npy"});
    expect_old_files_survive({"mesh", volume, "-o", out / "a.vtu", "--kuhn", "--quiet"}, {"a.vtu"});
    expect_old_files_survive({"mesh", volume, "-o", out / "a.node", "--kuhn", "--quiet"},
                             {"a.node", "a.ele"});
    expect_old_files_survive(
        {"generate", "gaussians", "-o", out / "a.nrrd", "--size", "32,32,32", "--quiet"},
        {"a.nrrd"});
    expect_old_files_survive(
        {"compare", folder / "a.png", folder / "b.png", "--diff", out / "a.png"}, {"a.png"});
    expect_old_files_survive({"integrate", folder / "segments.json", "-o", out / "a.json"},
                             {"a.json"});
    expect_old_files_survive({"info", folder / "mesh.vtu", "--png", out / "a.png"}, {"a.png"});
}

// The picture is written before and stays; the exit code says that the statistics are missing.
TEST_F(FaultsOfDisks, StatisticsThatDoNotFitAreAFailure) {
    for (const std::string option : {"--stats", "--profile"}) {
        const std::string picture = folder / "tiny.png", file = out / "a.json";
        const auto tiny =
            rendering(picture, {option, file, "--set", "image.width=4", "--set", "image.height=4"});
        make(tiny);
        ASSERT_LT(std::filesystem::file_size(picture), room);
        ASSERT_GT(std::filesystem::file_size(file), room);
        write_bytes_to(file, "old");
        expect_one_line(lamina_run(tiny, fill_the_disk), 1, {file, "cannot write"});
        EXPECT_EQ(read_bytes_of(file), "old") << option;
        EXPECT_EQ(contents(out).size(), 1u) << option;
    }
}

TEST_F(FaultsOfDisks, AStudyStopsAndGoesOnWhenThereIsRoom) {
    const auto study = [&](const std::string& name, const std::vector<std::string>& options) {
        std::vector<std::string> arguments{"study", folder / "study.json", "-o", out / name,
                                           "--quiet"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        return arguments;
    };
    make(study("whole", {}));
    // Limits the size of files to half of each file's size, so that each time another file does not
    // fit. Sizes vary, because times have different numbers of digits.
    std::set<rlim_t> limits;
    for (const auto& [name, bytes] : contents(out / "whole")) limits.insert(bytes.size() / 2);
    ASSERT_GT(limits.size(), 5u);
    for (const rlim_t room_now : limits) {
        const auto limit_size = [&] {
            const rlimit limit{room_now, room_now};
            setrlimit(RLIMIT_FSIZE, &limit);
        };
        const ProgramResult result = lamina_run(study("part", {}), limit_size);
        EXPECT_EQ(result.exit_code, 1) << room_now << result.err;
        if (room_now > room) expect_one_line(result, 1, {"part", "cannot write"});
        EXPECT_EQ(lamina_run(study("part", {"--resume"})).exit_code, 0);
        EXPECT_EQ(read_bytes_of(out / "part" / "results.csv").find("cannot write"),
                  std::string::npos);
        for (const auto& [name, bytes] : contents(out / "part"))
            EXPECT_FALSE(name.ends_with(".part")) << name;
        std::filesystem::remove_all(out / "part");
    }
}

TEST_F(FaultsOfDisks, FoldersThatCannotBeWrittenAreReportedInOneLine) {
    const auto expect_failure = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.end(), {"-o", out / "made", "--quiet"});
        expect_one_line(lamina_run(arguments, fill_the_disk), 1, {"made", "cannot write"});
        for (const auto& [name, bytes] : contents(out)) EXPECT_LE(bytes.size(), room) << name;
        // A file has the name of the folder.
        std::filesystem::remove_all(out / "made");
        write_bytes_to(out / "made", "old");
        expect_one_line(lamina_run(arguments), 1, {"made"});
        EXPECT_EQ(read_bytes_of(out / "made"), "old");
        std::filesystem::remove(out / "made");
    };
    expect_failure({"crosscheck", folder / "scene.json", "--tolerances", ".1", "--samples", "64",
                    "--context", "cpu"});
    expect_failure({"reproduce", "lamar", "table1"});
}

TEST_F(FaultsOfDisks, PlacesThatCannotBeWrittenAreNamed) {
    std::filesystem::create_directory(out / "folder.exr");
    write_bytes_to(out / "file", "old");
    std::filesystem::create_symlink("/dev/full", out / "device.exr");
    const auto before = contents(out);
    expect_one_line(lamina_run(rendering(out / "absent" / "a.exr")), 1, {"absent", "cannot write"});
    expect_one_line(lamina_run(rendering(out / "file" / "a.exr")), 1, {"file", "cannot write"});
    expect_one_line(lamina_run(rendering(out / "folder.exr")), 1, {"folder.exr", "directory"});
    expect_one_line(lamina_run(rendering(out / "device.exr")), 1, {"/dev/full", "device"});
    expect_one_line(lamina_run({"study", folder / "study.json", "-o", out / "file"}), 1, {"file"});
    EXPECT_EQ(contents(out), before);
}

TEST_F(FaultsOfDisks, InputsAreNotReplaced) {
    make(rendering(folder / "a.png"));
    make(rendering(folder / "b.png"));
    std::filesystem::create_symlink("volume.nrrd", folder / "link");
    const auto before = contents(folder.path());
    const std::string a = folder / "a.png", b = folder / "b.png";
    const std::string segments = folder / "segments.json";
    const std::vector<std::string> verbs[] = {
        {"compare", a, b, "--diff", a},
        {"compare", a, b, "--diff", b},
        {"integrate", segments, "-o", segments},
        rendering(folder / "c.png", {"--stats", folder / "scene.json"}),
        rendering(folder / "c.png", {"--stats", folder / "volume.nrrd"}),
        rendering(folder / "c.png", {"--profile", folder / "link"})};
    for (const std::vector<std::string>& arguments : verbs)
        expect_one_line(lamina_run(arguments), 2, {"expected different files"});
    EXPECT_EQ(contents(folder.path()), before);
}

// Files that the scene names, and files that belong to these, are inputs, too.
TEST_F(FaultsOfDisks, FilesOfASceneAreNotReplaced) {
    write_bytes_to(folder / "apart.nhdr",
                   "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n"
                   "data file: apart.raw\n");
    write_bytes_to(folder / "apart.raw", "01234567");
    write_bytes_to(folder / "colors.json",
                   R"([{"ColorSpace": "RGB", "RGBPoints": [0, 0, 0, 0, 255, 1, 1, 1]}])");
    make({"mesh", folder / "volume.nrrd", "-o", folder / "mesh.node", "--kuhn", "--quiet"});
    write_bytes_to(folder / "parts.json", R"({
        "version": 1, "volume": "apart.nhdr", "mesh": "mesh.ele",
        "transfer_function": {"colormap": "colors.json", "points": [
            {"value": 0, "extinction": 0}, {"value": 255, "extinction": 1}]},
        "camera": {"eye": [9, 3, 7], "center": [0.5, 0.5, 0.5], "up": [0, 0, 1]},
        "image": {"width": 8, "height": 8}, "render": {"method": "project"}})");
    const auto before = contents(folder.path());
    for (const char* name : {"apart.nhdr", "apart.raw", "colors.json", "mesh.node", "mesh.ele"}) {
        expect_one_line(lamina_run({"render", folder / "parts.json", "-o", folder / "c.png",
                                    "--context", "cpu", "--quiet", "--stats", folder / name}),
                        2, {"expected different files", name});
    }
    EXPECT_EQ(contents(folder.path()), before);
    make({"render", folder / "parts.json", "-o", folder / "c.png", "--context", "cpu", "--quiet"});
}

}  // namespace
}  // namespace lamina
