// SPDX-License-Identifier: Apache-2.0
// Commands replace neither files that they read nor files that others put into their output folder.
#include <nlohmann/json.hpp>

#include "cli/faults_test_case.h"

namespace lamina {
namespace {

class Folders : public FaultsTestCase {
  protected:
    // Expects a refusal, with and without --force, and unchanged files.
    void expect_different(std::vector<std::string> arguments, const std::string& name) {
        const auto before = contents(folder.path());
        expect_one_line(lamina_run(arguments), 2, {name, "is read: expected different files"});
        arguments.emplace_back("--force");
        expect_one_line(lamina_run(arguments), 2, {name, "is read: expected different files"});
        EXPECT_EQ(contents(folder.path()), before) << name;
    }
    // Expects that a file which lamina did not write is replaced only with --force.
    void expect_own(const std::vector<std::string>& arguments, const std::string& name) {
        std::filesystem::remove_all(out);
        std::filesystem::create_directory(out);
        write_bytes_to(out / name, "mine");
        expect_one_line(lamina_run(arguments), 1, {name, "not written by lamina", "--force"});
        EXPECT_EQ(contents(out), (std::map<std::string, std::string>{{out / name, "mine"}}));
        std::vector<std::string> forced = arguments;
        forced.emplace_back("--force");
        make(forced);
        EXPECT_NE(read_bytes_of(out / name), "mine") << name;
        write_bytes_to(out / "notes.txt", "of the user");
        make(arguments.front() == "study" ? with(arguments, "--resume")
                                          : arguments);  // now it is lamina's own
        EXPECT_EQ(read_bytes_of(out / "notes.txt"), "of the user");
    }
    static std::vector<std::string> with(std::vector<std::string> arguments,
                                         const std::string& option) {
        arguments.push_back(option);
        return arguments;
    }
    // Writes a study whose scenes lie in the folder above it, and returns its path.
    std::string study_at(const std::filesystem::path& path) const {
        auto study = nlohmann::json::parse(read_bytes_of(folder / "study.json"));
        study["scenes"] = {folder / "scene.json"};
        write_bytes_to(path, study.dump());
        return path;
    }
    void name_in_scene(const std::string& key, const std::string& value) const {
        auto scene = nlohmann::json::parse(read_bytes_of(folder / "scene.json"));
        scene[key] = value;
        write_bytes_to(folder / "scene.json", scene.dump());
    }
};

TEST_F(Folders, AStudyFileIsNotReplacedByItsResults) {
    for (const char* name : {"results.json", "results.csv", "report.html", "runs.json",
                             "journal-1-of-1.jsonl", "lamina-files.txt"}) {
        const std::string study = study_at(out / name);
        expect_different({"study", study, "-o", out}, name);
        std::filesystem::remove(study);
    }
}

TEST_F(Folders, ASceneOrItsDataAreNotReplacedByACrosscheck) {
    std::filesystem::copy_file(folder / "scene.json", out / "budget.json");
    std::filesystem::copy_file(folder / "volume.nrrd", out / "volume.nrrd");
    expect_different({"crosscheck", out / "budget.json", "-o", out}, "budget.json");
    std::filesystem::remove(out / "budget.json");
    write_bytes_to(folder / "apart.nhdr",
                   "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n"
                   "data file: out/sliced.exr\n");
    write_bytes_to(out / "sliced.exr", "01234567");
    name_in_scene("volume", "apart.nhdr");
    expect_different({"crosscheck", folder / "scene.json", "-o", out}, "sliced.exr");
}

TEST_F(Folders, AStudysDataAreNotReplaced) {
    write_bytes_to(folder / "apart.nhdr",
                   "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n"
                   "data file: out/results.csv\n");
    write_bytes_to(out / "results.csv", "01234567");
    const std::string volume = folder / "scene.json";
    name_in_scene("volume", "apart.nhdr");
    expect_different({"study", folder / "study.json", "-o", out}, "results.csv");
    // Pictures, too, under any name that leads to the file.
    std::filesystem::create_directory(out / "pictures");
    std::filesystem::create_symlink(folder / "scene.json", out / "pictures" / "0123.exr");
    std::filesystem::remove(out / "results.csv");
    name_in_scene("volume", "volume.nrrd");
    expect_different({"study", folder / "study.json", "-o", out}, "0123.exr");
}

TEST_F(Folders, LinksToInputsAreNotReplaced) {
    std::filesystem::create_hard_link(folder / "scene.json", out / "budget.json");
    expect_different({"crosscheck", folder / "scene.json", "-o", out}, "budget.json");
    std::filesystem::remove(out / "budget.json");
    std::filesystem::create_symlink(folder / "volume.nrrd", out / "projected.exr");
    expect_different({"crosscheck", folder / "scene.json", "-o", out}, "projected.exr");
    // Commands that write single files refuse this, too.
    std::filesystem::create_hard_link(folder / "volume.nrrd", out / "a.exr");
    expect_one_line(lamina_run(rendering(out / "a.exr")), 2, {"a.exr", "is read"});
    expect_one_line(lamina_run(rendering(out / "b.exr", {"--stats", out / "b.exr"})), 2,
                    {"b.exr", "twice"});
}

TEST_F(Folders, NoVerbReplacesWhatItReads) {
    const auto nhdr = [&](const std::string& data) {
        write_bytes_to(out / "apart.nhdr",
                       "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n"
                       "data file: " +
                           data + "\n");
        write_bytes_to(out / data, "01234567");
        return out / "apart.nhdr";
    };
    const auto expect_refused = [&](const std::vector<std::string>& arguments,
                                    const std::string& name) {
        const auto before = contents(folder.path());
        expect_one_line(lamina_run(arguments), 2, {name, "is read: expected different files"});
        EXPECT_EQ(contents(folder.path()), before);
    };
    expect_refused({"mesh", nhdr("a.ele"), "-o", out / "a.node", "--kuhn"}, "a.ele");
    expect_refused({"mesh", nhdr("a.vtu"), "-o", out / "a.vtu", "--kuhn"}, "a.vtu");
    name_in_scene("volume", nhdr("b.vtu"));
    expect_refused({"mesh", folder / "scene.json", "-o", out / "b.vtu", "--kuhn"}, "b.vtu");
    expect_refused({"info", nhdr("a.png"), "--png", out / "a.png"}, "a.png");
    write_bytes_to(out / "colors.json",
                   R"([{"ColorSpace": "RGB", "RGBPoints": [0, 0, 0, 0, 255, 1, 1, 1]}])");
    write_bytes_to(out / "segments.json", R"([{"transfer_function": {"colormap": "colors.json",
        "points": [{"value": 0, "extinction": 1}]}, "sf": 0, "sb": 1, "length": 1}])");
    expect_refused({"integrate", out / "segments.json", "-o", out / "colors.json"}, "colors.json");
    make({"integrate", out / "segments.json", "-o", out / "integrals.json"});
}

TEST_F(Folders, FilesThatAStudyDidNotWriteAreNotReplaced) {
    for (const char* name : {"results.json", "results.csv", "report.html"})
        expect_own({"study", folder / "study.json", "-o", out, "--quiet"}, name);
    std::filesystem::remove_all(out);
    std::filesystem::create_directories(out / "pictures");
    write_bytes_to(out / "pictures" / "mine.exr", "mine");
    const std::vector<std::string> study{"study", folder / "study.json", "-o", out, "--quiet"};
    expect_one_line(lamina_run(study), 1, {"pictures", "not written by lamina study"});
    make(with(study, "--force"));
    EXPECT_EQ(read_bytes_of(out / "pictures" / "mine.exr"), "mine");
    // Results that were copied from another folder do not count as written here.
    std::filesystem::create_directory(folder / "merged");
    std::filesystem::copy_file(out / "report.html", folder / "merged" / "report.html");
    const std::vector<std::string> merge{"study", "--merge", out, "-o", folder / "merged"};
    expect_one_line(lamina_run(merge), 1, {"report.html", "not written by lamina study"});
    make(with(merge, "--force"));
    make(merge);
}

TEST_F(Folders, FilesThatAReproductionDidNotWriteAreNotReplaced) {
    for (const char* name : {"table3.csv", "lamar.json", "lamar.html"})
        expect_own({"reproduce", "lamar", "table3", "-o", out}, name);
    write_bytes_to(out / "figure2.svg", "mine");  // belongs to an item that is not made here
    make({"reproduce", "lamar", "table3", "-o", out});
    expect_one_line(lamina_run({"reproduce", "lamar", "figure2", "-o", out}), 1, {"figure2.svg"});
}

TEST_F(Folders, FilesThatASelftestDidNotWriteAreNotReplaced) {
    expect_own({"selftest", "--group", "metamorphic", "--context", "cpu", "--quiet", "-o", out},
               "selftest.txt");
}

TEST_F(Folders, FilesThatACrosscheckDidNotWriteAreNotReplaced) {
    if (std::string(LAMINA_TETRAHEDRALIZE_BINARY).empty()) GTEST_SKIP() << "built without TetGen";
    for (const char* name : {"report.html", "sliced.exr"}) {
        expect_own({"crosscheck", folder / "scene.json", "-o", out, "--context", "cpu", "--quiet",
                    "--tolerances", ".3", "--samples", "8", "--set", "image.width=8", "--set",
                    "image.height=6"},
                   name);
    }
}

}  // namespace
}  // namespace lamina
