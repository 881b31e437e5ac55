// SPDX-License-Identifier: Apache-2.0
#include "base/atomic_file.h"

#include <gtest/gtest.h>

#include "support/expect_error.h"
#include "support/file_size_limit.h"
#include "support/temporary_folder.h"

namespace lamina {
namespace {

TEST(AtomicFile, AppearsUnderItsNameOnlyWhenCommitted) {
    const TemporaryFolder folder;
    {
        AtomicFile file(folder / "a.txt");
        file.write("new");
        EXPECT_FALSE(std::filesystem::exists(folder / "a.txt"));
        EXPECT_TRUE(std::filesystem::exists(file.temporary_path()));
        EXPECT_EQ(file.temporary_path().parent_path(),
                  folder.path());  // rename needs one file system
        file.commit();
        EXPECT_FALSE(std::filesystem::exists(file.temporary_path()));
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
    // Who had opened the old file still reads the old file: it was replaced, not overwritten.
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>(old_reader), {}), "old");
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

TEST(AtomicFile, CanBeWrittenByNameAfterItsStreamIsClosed) {
    const TemporaryFolder folder;
    AtomicFile file(folder / "a.txt");
    file.close_stream();
    write_bytes_to(file.temporary_path(), "by name");
    file.commit();
    EXPECT_EQ(read_bytes_of(folder / "a.txt"), "by name");
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
        expect_error([&] { write(1000000); }, {"a.txt", "cannot write"});  // seen while writing
        expect_error([&] { write(1001); }, {"a.txt", "cannot write"});     // seen while closing
    }
    EXPECT_TRUE(folder.empty());
}

}  // namespace
}  // namespace lamina
