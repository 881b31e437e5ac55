// SPDX-License-Identifier: Apache-2.0
#include "base/output_file.h"

#include <gtest/gtest.h>

#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace lamina {
namespace {

TEST(OwnFiles, RefuseExistingFilesThatAreNotListed) {
    const TemporaryFolder folder;
    const OwnFiles own(folder.path(), "study");
    own.expect_own({"a.csv", "b.csv"});  // neither file exists yet
    own.add({"a.csv"});
    write_bytes_to(folder / "a.csv", "1");
    own.expect_own({"a.csv", "b.csv"});
    write_bytes_to(folder / "b.csv", "1");
    expect_error(
        [&] {
            own.expect_own({"a.csv", "b.csv"});
        },
        {"b.csv", "not written by lamina study", "--force"});
    own.add({"b.csv"});
    own.expect_own({"a.csv", "b.csv"});
}

TEST(OwnFiles, BelongToOneVerbOfTheProgram) {
    const TemporaryFolder folder;
    const OwnFiles study(folder.path(), "study"), crosscheck(folder.path(), "crosscheck");
    study.add({"report.html"});
    write_bytes_to(folder / "report.html", "");
    expect_error([&] { crosscheck.expect_own({"report.html"}); }, {"report.html", "crosscheck"});
    crosscheck.add({"budget.json"});
    study.expect_own({"report.html"});  // lines of one verb stay when another verb adds its own
}

TEST(OwnFiles, RefuseUnlistedFoldersAndDanglingLinks) {
    const TemporaryFolder folder;
    const OwnFiles own(folder.path(), "study");
    std::filesystem::create_directory(folder / "pictures");
    std::filesystem::create_symlink("absent", folder / "link");
    expect_error([&] { own.expect_own({"pictures"}); }, {"pictures"});
    expect_error([&] { own.expect_own({"link"}); }, {"link"});
}

TEST(OwnFiles, AddMakesTheFolder) {
    const TemporaryFolder folder;
    OwnFiles(folder / "new/place", "study").add({"a"});
    EXPECT_TRUE(std::filesystem::exists(folder / "new/place" / OwnFiles::list_name));
}

TEST(OwnFiles, AnotherFileOfTheListsNameIsLeftAlone) {
    const TemporaryFolder folder;
    const OwnFiles own(folder.path(), "study");
    for (const char* text : {"", "\n", "my files\nstudy: a.csv\n"}) {
        write_bytes_to(folder / OwnFiles::list_name, text);
        expect_error([&] { own.expect_own({}); }, {OwnFiles::list_name, "not a list"});
        expect_error([&] { own.add({"a.csv"}); }, {OwnFiles::list_name, "not a list"});
        EXPECT_EQ(read_bytes_of(folder / OwnFiles::list_name), text);
    }
}

TEST(OwnFiles, RemovesWhatTheVerbWroteAndNothingElse) {
    const TemporaryFolder folder;
    const std::filesystem::path place = folder / "place";
    const OwnFiles own(place, "render"), other(place, "study");
    own.add({"a", "b", "absent", "../outside", "lies/below"});
    other.add({"c"});
    std::filesystem::create_directory(place / "lies");
    for (const char* name : {"a", "b", "c", "d", "../outside", "lies/below"})
        write_bytes_to(place / name, "1");
    own.remove_all();
    EXPECT_FALSE(std::filesystem::exists(place / "a") || std::filesystem::exists(place / "b"));
    for (const char* name : {"c", "d", "../outside", "lies/below", OwnFiles::list_name})
        EXPECT_TRUE(std::filesystem::exists(place / name)) << name;
    std::filesystem::remove_all(place / "lies");
    std::filesystem::remove(place / "d");
    other.remove_all();
    EXPECT_FALSE(std::filesystem::exists(place));
}

}  // namespace
}  // namespace lamina
