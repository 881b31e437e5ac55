// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/lamina_run.h"
#include "support/temporary_folder.h"

namespace lamina {
namespace {

using nlohmann::json;

ProgramResult run_in(const TemporaryFolder& folder, const std::vector<std::string>& arguments) {
    const std::string path = folder.path();
    return lamina_run(arguments, [path] {
        if (chdir(path.c_str()) != 0) _exit(126);
    });
}

TEST(ExampleVerb, ListsItsNamesWithASentenceEach) {
    const TemporaryFolder folder;
    const ProgramResult list = run_in(folder, {"example"});
    ASSERT_EQ(list.exit_code, 0);
    EXPECT_EQ(list.err, "");
    std::istringstream lines(list.out);
    int count = 0;
    for (std::string line; std::getline(lines, line); ++count) {
        std::istringstream words(line);
        std::string name;
        words >> name;
        // The line ends with the file that NAME alone writes.
        const std::string file =
            line.substr(line.rfind('(') + 1, line.size() - line.rfind('(') - 2);
        const ProgramResult made = run_in(folder, {"example", name});
        EXPECT_EQ(made.exit_code, 0) << name;
        EXPECT_EQ(made.err, "lamina: wrote " + file + "\n");
        EXPECT_TRUE(std::filesystem::exists(folder / file)) << file;
        EXPECT_LT(std::filesystem::file_size(folder / file), 8'000'000u) << file;
        const ProgramResult info = run_in(folder, {"info", file, "--json"});
        EXPECT_EQ(info.exit_code, 0) << info.err;
    }
    EXPECT_EQ(count, 5);
}

TEST(ExampleVerb, WritesFilesThatSayWhatTheyHold) {
    const TemporaryFolder folder;
    for (const char* const name : {"head", "labels", "jet"})
        ASSERT_EQ(run_in(folder, {"example", name, "--quiet", "-o", std::string(name) + ".nrrd"})
                      .exit_code,
                  0);
    const json head = json::parse(run_in(folder, {"info", "head.nrrd", "--json"}).out);
    EXPECT_EQ(head["type"], "int16");
    EXPECT_EQ(head["unit"], "mm");
    EXPECT_EQ(head["spacing"], json({1.5, 1.5, 1.5}));
    const std::string bytes = read_bytes_of(folder / "head.nrrd");
    EXPECT_NE(bytes.find("space: left-posterior-superior\n"), std::string::npos);
    EXPECT_NE(bytes.find("sample units: HU\n"), std::string::npos);
    const ProgramResult labels = run_in(folder, {"info", "labels.nrrd", "--json"});
    EXPECT_NE(labels.err.find("6 is \"cerebellum\""), std::string::npos) << labels.err;
    const json jet = json::parse(run_in(folder, {"info", "jet.nrrd", "--json"}).out);
    EXPECT_EQ(jet["size"], json({64, 64, 128}));
    EXPECT_EQ(jet["times"].size(), 10u);
}

TEST(ExampleVerb, RefusesWhatItCannotWrite) {
    const TemporaryFolder folder;
    const auto refused = [&](const std::vector<std::string>& arguments, const std::string& reason) {
        const ProgramResult result = run_in(folder, arguments);
        EXPECT_EQ(result.exit_code, 2);
        EXPECT_NE(result.err.find(reason), std::string::npos) << result.err;
        EXPECT_TRUE(folder.empty());
    };
    refused({"example", "teapot"},
            "NAME: found 'teapot', expected one of head, labels, jet, flow, cells");
    refused({"example", "head", "-o", "head.vtu"}, "expected a name that ends in .nrrd");
    refused({"example", "flow", "-o", "flow.nrrd"}, "expected a name that ends in .vtu");
    refused({"example", "-o", "head.nrrd"}, "expected a NAME before it");
}

}  // namespace
}  // namespace lamina
