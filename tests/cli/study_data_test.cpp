// SPDX-License-Identifier: Apache-2.0
// lamina study: all results come from the same data, and special files in its folder are refused.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>

#include "cli/study_test_case.h"

namespace lamina {
namespace {

using nlohmann::json;

class StudyDataSets : public StudyTestCase {
  protected:
    void make_volume(const std::string& formula, const std::string& size = "16,16,16") {
        const ProgramResult made =
            lamina_run({"generate", formula, "-o", folder / "made.nrrd", "--size", size});
        ASSERT_EQ(made.exit_code, 0) << made.err;
    }
    void use_volume() {
        blobs["volume"] = "made.nrrd";
        blobs["mesh"] = {{"kuhn", true}};
    }
    static void expect_one_line(const ProgramResult& result,
                                const std::vector<std::string>& parts) {
        EXPECT_EQ(result.exit_code, 1) << result.err;
        EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
        for (const std::string& part : parts)
            EXPECT_NE(result.err.find(part), std::string::npos) << part << ": " << result.err;
    }
    // Returns the hash in runs.json of the data set with this name.
    std::string content_of(const std::string& output, const std::string& name) const {
        const json list = document(output, "runs.json");
        for (const json& data : list["data"]) {
            if (data["name"].get<std::string>().ends_with(name)) return data["content"];
        }
        ADD_FAILURE() << name;
        return {};
    }
    void expect_refused_after(const std::string& name, const std::function<void()>& change) {
        std::filesystem::remove_all(folder / "out");
        run_well("out");
        const std::string expected = content_of("out", name);
        const auto before = contents(folder / "out");
        change();
        expect_one_line(run("out", {"--resume"}), {name, expected, "out/runs.json"});
        EXPECT_EQ(contents(folder / "out"), before);
    }
};

TEST_F(StudyDataSets, AChangedVolumeEndsResuming) {
    use_volume();
    make_volume("gaussians");
    expect_refused_after("made.nrrd", [&] { make_volume("marschner-lobb"); });
    // A change of one sample, or of the volume's position, is enough.
    const std::string file = folder / "made.nrrd", bytes = read_bytes_of(file);
    expect_refused_after("made.nrrd", [&] {
        std::string changed = bytes;
        changed.back() = static_cast<char>(changed.back() ^ 1);
        write_bytes_to(file, changed);
    });
    write_bytes_to(file, bytes);
    expect_refused_after("made.nrrd", [&] {
        std::string changed = bytes;
        const std::string origin = "space origin: (0";
        const std::size_t at = changed.find(origin);
        ASSERT_NE(at, std::string::npos) << bytes.substr(0, 300);
        changed.replace(at, origin.size(), "space origin: (1");
        write_bytes_to(file, changed);
    });
}

TEST_F(StudyDataSets, AChangedMeshOrColormapEndsResuming) {
    make_volume("gaussians", "4,4,4");
    const auto make_mesh = [&] {
        const ProgramResult made = lamina_run(
            {"mesh", folder / "made.nrrd", "-o", folder / "made.node", "--kuhn", "--quiet"});
        ASSERT_EQ(made.exit_code, 0) << made.err;
    };
    make_mesh();
    const auto write_colors = [&](const char* red) {
        write_bytes_to(folder / "colors.json",
                       std::string(R"({"RGBPoints": [0, 0, 0, 0, 255, )") + red + ", 1, 1]}");
    };
    write_colors("1");
    blobs["mesh"] = "made.node";
    blobs["transfer_function"] = json::parse(R"({"colormap": "colors.json", "points": [
        {"value": 0, "extinction": 0}, {"value": 255, "extinction": 8}]})");
    expect_refused_after("made.node", [&] {
        make_volume("marschner-lobb", "4,4,4");
        make_mesh();
    });
    expect_refused_after("colors.json", [&] { write_colors("0.9"); });
}

// The file is written differently, but the volume is the same.
TEST_F(StudyDataSets, EqualSamplesInAnotherFileAreResumed) {
    use_volume();
    make_volume("gaussians");
    run_well("out");
    std::string text = read_bytes_of(folder / "made.nrrd");
    text.insert(text.find('\n') + 1, "# the same samples\n");
    write_bytes_to(folder / "made.nrrd", text);
    const ProgramResult again = run_well("out", {"--resume"});
    EXPECT_NE(again.err.find("6 runs, 6 of them finished before"), std::string::npos) << again.err;
}

TEST_F(StudyDataSets, ShardsOfDifferentDataDoNotMerge) {
    use_volume();
    make_volume("gaussians");
    run_well("a", {"--shard", "1/2"});
    make_volume("marschner-lobb");
    run_well("b", {"--shard", "2/2"});
    expect_one_line(
        lamina_run({"study", "--merge", folder / "a", folder / "b", "-o", folder / "merged"}),
        {"made.nrrd", content_of("a", "made.nrrd"), content_of("b", "made.nrrd"), "a/runs.json",
         "b/runs.json"});
    EXPECT_FALSE(std::filesystem::exists(folder / "merged"));
    // One folder cannot have shards of different data, either.
    expect_one_line(run("a", {"--shard", "2/2"}), {"made.nrrd", "a/runs.json"});
}

TEST_F(StudyDataSets, AListWithoutHashesIsOfAnOlderVersion) {
    run_well("out");
    json list = document("out", "runs.json");
    list.erase("data");
    write_bytes_to(folder / "out" / "runs.json", list.dump());
    expect_one_line(run("out", {"--resume"}), {"runs.json", "older lamina"});
}

TEST_F(StudyDataSets, ADamagedReferenceIsMadeAgainAndReported) {
    run_well("out");
    const auto before = contents(folder / "out" / "references");
    const std::vector<CsvRow> rows = results("out");
    std::string npy, facts;
    for (const auto& [name, bytes] : before) (name.ends_with(".npy") ? npy : facts) = name;
    const auto expect_mended = [&](const std::string& name, const auto& damage) {
        damage();
        const ProgramResult again = run_well("out", {"--resume"});
        EXPECT_NE(again.err.find(name), std::string::npos) << again.err;
        EXPECT_NE(again.err.find("the reference is traced again"), std::string::npos) << again.err;
        EXPECT_EQ(read_bytes_of(npy), before.at(npy));
        expect_every_run_once("out");
        const std::vector<CsvRow> after = results("out");
        for (std::size_t i = 0; i < rows.size(); ++i) {
            EXPECT_EQ(after[i].at("linf"), rows[i].at("linf"));
            EXPECT_EQ(after[i].at("reference_error"), rows[i].at("reference_error"));
        }
        EXPECT_EQ(run_well("out", {"--resume"}).err.find("again"), std::string::npos);
    };
    const std::string bytes = before.at(npy);
    expect_mended(npy, [&] { write_bytes_to(npy, bytes.substr(0, bytes.size() / 2)); });
    expect_mended(npy, [&] { write_bytes_to(npy, ""); });
    expect_mended(npy, [&] { std::filesystem::remove(npy); });
    expect_mended(npy, [&] {  // a changed pixel; the length stays
        std::string changed = bytes;
        changed[changed.size() - 100] = static_cast<char>(changed[changed.size() - 100] ^ 1);
        write_bytes_to(npy, changed);
    });
    expect_mended(facts, [&] { write_bytes_to(facts, "{"); });
    expect_mended(facts, [&] { std::filesystem::remove(facts); });
}

TEST_F(StudyDataSets, AMergeTakesTheReferenceThatIsWhole) {
    run_well("a", {"--shard", "1/2"});
    run_well("b", {"--shard", "2/2"});
    for (const auto& [name, bytes] : contents(folder / "a" / "references")) {
        if (name.ends_with(".npy") &&
            std::filesystem::exists(folder / "b" / "references" /
                                    std::filesystem::path(name).filename()))
            write_bytes_to(name, "damaged");
    }
    const ProgramResult merged =
        lamina_run({"study", "--merge", folder / "a", folder / "b", "-o", folder / "merged"});
    EXPECT_EQ(merged.exit_code, 0) << merged.err;
    EXPECT_NE(merged.err.find("left out"), std::string::npos) << merged.err;
    expect_every_run_once("merged");
}

// Opening a pipe would wait for its other end.
TEST_F(StudyDataSets, PipesAreRefused) {
    run_well("out");
    const auto expect_refused = [&](const std::filesystem::path& path, auto&& arguments) {
        const auto kept = folder / "kept";
        std::filesystem::rename(path, kept);
        ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
        const ProgramResult result = run_program(arguments);
        EXPECT_EQ(result.exit_code, 1) << result.err;
        EXPECT_NE(result.err.find(path.filename().string()), std::string::npos) << result.err;
        std::filesystem::remove(path);
        std::filesystem::rename(kept, path);
    };
    const auto resumed = command("out", {"--resume"});
    const std::vector<std::string> merged{LAMINA_BINARY,  "study", "--merge",
                                          folder / "out", "-o",    folder / "merged"};
    const auto some = [&](const char* place, const char* suffix) {
        for (const auto& entry : std::filesystem::directory_iterator(folder / "out" / place)) {
            if (entry.path().extension() == suffix) return entry.path();
        }
        return std::filesystem::path();
    };
    for (const auto& path : {folder / "out" / "journal-1-of-1.jsonl", folder / "out" / "runs.json",
                             some("references", ".npy"), some("references", ".json"),
                             some("pictures", ".exr"), folder / "out" / "lamina-files.txt"})
        expect_refused(path, resumed);
    for (const auto& path : {folder / "out" / "journal-1-of-1.jsonl", folder / "out" / "runs.json",
                             some("pictures", ".exr")})
        expect_refused(path, merged);
}

}  // namespace
}  // namespace lamina
