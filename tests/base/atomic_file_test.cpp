// SPDX-License-Identifier: Apache-2.0
#include "base/output_file.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <set>
#include <string>

#include "support/expect_error.h"
#include "support/file_size_limit.h"
#include "support/nameless_files.h"
#include "support/temporary_folder.h"

namespace lamina {
namespace {

std::set<std::string> names_in(const TemporaryFolder& folder) {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
        names.insert(entry.path().filename().string());
    return names;
}

TEST(AtomicFile, AppearsUnderItsNameOnlyWhenCommitted) {
    const TemporaryFolder folder;
    {
        AtomicFile file(folder / "a.txt");
        file.write("new");
        EXPECT_FALSE(std::filesystem::exists(folder / "a.txt"));
        file.commit();
        EXPECT_EQ(names_in(folder), std::set<std::string>{"a.txt"});
    }
    EXPECT_EQ(read_bytes_of(folder / "a.txt"), "new");
}

TEST(AtomicFile, ReplacesAnOldFileInOneStep) {
    const TemporaryFolder folder;
    write_bytes_to(folder / "a.txt", "old");
    std::ifstream old_reader(folder / "a.txt");
    AtomicFile file(folder / "a.txt");
    file.write("a longer text");
    EXPECT_EQ(read_bytes_of(folder / "a.txt"), "old");
    file.commit();
    EXPECT_EQ(read_bytes_of(folder / "a.txt"), "a longer text");
    // A stream that was opened before still reads the old file: the file is replaced, not
    // overwritten.
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>(old_reader), {}), "old");
}

TEST(AtomicFile, KeepsTheModeOfWhatItReplaces) {
    const TemporaryFolder folder;
    for (const mode_t mode : {0600, 0640, 0666, 0444}) {
        const std::filesystem::path path = folder / fmt::format("{:o}.txt", mode);
        write_bytes_to(path, "old");
        ASSERT_EQ(chmod(path.c_str(), mode), 0);
        std::filesystem::create_symlink(path, path.string() + ".link");
        for (const std::string& name : {path.string(), path.string() + ".link"}) {
            AtomicFile file(name);
            file.write("new");
            file.commit();
            struct stat found = {};
            ASSERT_EQ(stat(path.c_str(), &found), 0);
            EXPECT_EQ(found.st_mode & 0777, mode);
            EXPECT_EQ(read_bytes_of(path), "new");
        }
    }
}

// Long work would be lost if rename() failed after it.
TEST(AtomicFile, FailsAtOnceIfAnotherUsersFileCannotBeReplaced) {
    if (geteuid() != 0) GTEST_SKIP() << "only root can work as another user";
    const TemporaryFolder folder;
    write_bytes_to(folder / "a.txt", "old");
    ASSERT_EQ(chmod(folder.path().c_str(), 01777), 0);
    constexpr uid_t nobody = 65534;
    ASSERT_EQ(seteuid(nobody), 0);
    const std::string message = error_of([&] { AtomicFile(folder / "a.txt"); });
    AtomicFile(folder / "b.txt").commit();
    ASSERT_EQ(seteuid(0), 0);
    EXPECT_NE(message.find("a.txt: cannot write: Operation not permitted"), std::string::npos)
        << message;
    EXPECT_EQ(names_in(folder), (std::set<std::string>{"a.txt", "b.txt"}));
}

TEST(AtomicFile, LeavesNothingWithoutCommit) {
    const TemporaryFolder folder;
    const auto interrupted_work = [&] {
        AtomicFile file(folder / "a.txt");
        file.write("half of it");
        fail("something went wrong");
    };
    EXPECT_THROW(interrupted_work(), Error);
    EXPECT_TRUE(folder.empty());

    write_bytes_to(folder / "a.txt", "old");
    EXPECT_THROW(interrupted_work(), Error);
    EXPECT_EQ(read_bytes_of(folder / "a.txt"), "old");
}

// The file has no name before commit(), so a killed process leaves nothing (if the file system
// allows it).
TEST(AtomicFile, HasNoNameUntilItIsComplete) {
    const TemporaryFolder folder;
    if (!has_nameless_files(folder)) GTEST_SKIP() << "files of this file system all have names";
    AtomicFile file(folder / "a.txt");
    file.write(std::string(100000, 'x'));
    EXPECT_TRUE(folder.empty());
}

TEST(AtomicFile, IsNotReplacedByCompleteWithoutCommit) {
    const TemporaryFolder folder;
    write_bytes_to(folder / "a.txt", "old");
    {
        AtomicFile file(folder / "a.txt");
        file.write("new");
        file.complete();
        EXPECT_EQ(read_bytes_of(folder / "a.txt"), "old");
        EXPECT_EQ(names_in(folder).size(), 2u);
    }
    EXPECT_EQ(names_in(folder), std::set<std::string>{"a.txt"});
    EXPECT_EQ(read_bytes_of(folder / "a.txt"), "old");
    AtomicFile file(folder / "a.txt");
    file.write("new");
    file.complete();
    file.commit();
    EXPECT_EQ(names_in(folder), std::set<std::string>{"a.txt"});
    EXPECT_EQ(read_bytes_of(folder / "a.txt"), "new");
}

TEST(AtomicFile, TwoWritersOfOneNameDoNotInterfere) {
    const TemporaryFolder folder;
    AtomicFile one(folder / "a.txt"), two(folder / "a.txt");
    one.write("one");
    two.write("two");
    two.complete();
    one.complete();
    two.commit();
    EXPECT_EQ(read_bytes_of(folder / "a.txt"), "two");
    one.commit();
    EXPECT_EQ(read_bytes_of(folder / "a.txt"), "one");
    EXPECT_EQ(names_in(folder), std::set<std::string>{"a.txt"});
}

// Tests the names NAME.lamina-N.part, which remain if a process is killed during commit() or if the
// file system has no nameless files.
TEST(AtomicFile, RemovesLeftoversOfKilledProcessesButNoFileInUse) {
    const TemporaryFolder folder;
    write_bytes_to(folder / "a.txt.lamina-0.part", "left");
    AtomicFile one(folder / "a.txt");
    one.write("one");
    one.complete();
    EXPECT_EQ(names_in(folder), std::set<std::string>{"a.txt.lamina-0.part"});
    EXPECT_EQ(read_bytes_of(folder / "a.txt.lamina-0.part"), "one");
    AtomicFile two(folder / "a.txt");
    two.write("two");
    two.complete();
    EXPECT_EQ(names_in(folder),
              (std::set<std::string>{"a.txt.lamina-0.part", "a.txt.lamina-1.part"}));
    two.commit();
    one.commit();
    EXPECT_EQ(names_in(folder), std::set<std::string>{"a.txt"});
    EXPECT_EQ(read_bytes_of(folder / "a.txt"), "one");
    // Not a file that lamina writes.
    std::filesystem::create_directory(folder / "a.txt.lamina-0.part");
    AtomicFile three(folder / "a.txt");
    three.write("three");
    three.commit();
    EXPECT_EQ(read_bytes_of(folder / "a.txt"), "three");
    EXPECT_EQ(names_in(folder), (std::set<std::string>{"a.txt", "a.txt.lamina-0.part"}));
}

TEST(AtomicFile, TakesNamesAsLongAsTheFileSystemAllows) {
    const TemporaryFolder folder;
    const std::string longest(255, 'n');
    for (const char* text : {"new", "newer"}) {
        AtomicFile file(folder / longest);
        file.write(text);
        file.commit();
        EXPECT_EQ(read_bytes_of(folder / longest), text);
    }
    expect_error([&] { AtomicFile(folder / (longest + "n")); }, {"cannot write", "too long"});
}

TEST(AtomicFile, WritesWhatALinkLeadsTo) {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "there");
    std::filesystem::create_symlink("there/b.txt", folder / "a.txt");  // b.txt does not exist yet
    std::filesystem::create_symlink("a.txt", folder / "again");
    for (const char* text : {"new", "newer"}) {
        AtomicFile file(folder / "again");
        file.write(text);
        file.commit();
        EXPECT_EQ(read_bytes_of(folder / "there" / "b.txt"), text);
        EXPECT_TRUE(std::filesystem::is_symlink(folder / "a.txt"));
        EXPECT_TRUE(std::filesystem::is_symlink(folder / "again"));
    }
    std::filesystem::create_symlink("y", folder / "x");
    std::filesystem::create_symlink("x", folder / "y");
    expect_error([&] { AtomicFile(folder / "x"); }, {"cannot write", "loop"});
}

TEST(AtomicFile, FailsIfItsFolderIsGone) {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "gone");
    AtomicFile file(folder / "gone" / "a.txt");
    file.write("new");
    std::filesystem::remove_all(folder / "gone");
    expect_error([&] { file.commit(); }, {"gone/a.txt", "cannot write"});
    EXPECT_TRUE(folder.empty());
}

TEST(AtomicFile, PathsThatCannotBeWrittenFailAtOnce) {
    const TemporaryFolder folder;
    write_bytes_to(folder / "file", "");
    expect_error([&] { AtomicFile(folder / "absent" / "a.txt"); },
                 {"absent/a.txt", "cannot write"});
    expect_error([&] { AtomicFile(folder / "file" / "a.txt"); }, {"file/a.txt", "cannot write"});
    expect_error([&] { AtomicFile(folder.path()); }, {"directory"});
}

TEST(AtomicFile, FullDiskIsAnErrorAndLeavesNothing) {
    const TemporaryFolder folder;
    const auto write = [&](std::size_t bytes) {
        AtomicFile file(folder / "a.txt");
        file.write(std::string(bytes, 'x'));
        file.commit();
    };
    {
        const FileSizeLimit limit(1000);
        // The error occurs while writing.
        expect_error([&] { write(1000000); }, {"a.txt", "cannot write"});
        // The error occurs while closing.
        expect_error([&] { write(1001); }, {"a.txt", "cannot write"});
    }
    EXPECT_TRUE(folder.empty());
}

}  // namespace
}  // namespace lamina
