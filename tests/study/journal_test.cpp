// SPDX-License-Identifier: Apache-2.0
#include "study/study_results.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace lamina::study {
namespace {

using nlohmann::json;

TEST(Journal, KeepsRecordsInTheirOrder) {
    const TemporaryFolder folder;
    const auto path = folder / "j.jsonl";
    std::vector<json> written;
    for (int opening = 0; opening < 3; ++opening) {
        Journal journal(path);
        EXPECT_EQ(journal.found(), written);
        for (int i = 0; i < 4; ++i) {
            journal.append({{"run", opening}, {"round", i}, {"frame_ms", {0.1, 1e-300}}});
            written.push_back({{"run", opening}, {"round", i}, {"frame_ms", {0.1, 1e-300}}});
            // The record is on disk when append() returns, not only when the journal is closed.
            EXPECT_EQ(Journal::read(path), written);
        }
    }
}

TEST(Journal, ARecordIsALine) {
    const TemporaryFolder folder;
    const auto path = folder / "j.jsonl";
    const std::string message = "two\nlines, \"quotes\" and what is no UTF-8: \xff";
    Journal(path).append({{"failed", message}});
    const std::string text = read_bytes_of(path);
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1);
    EXPECT_EQ(Journal::read(path).at(0).at("failed").get<std::string>().substr(0, 20),
              message.substr(0, 20));
}

// A kill may leave any beginning of the last line.
TEST(Journal, ATornLastLineIsTakenAway) {
    const TemporaryFolder folder;
    const auto path = folder / "j.jsonl";
    const std::string first = "{\"run\":\"a\"}\n", last = "{\"run\":\"b\",\"round\":0}";
    const std::vector<json> complete{json{{"run", "a"}}};
    for (std::size_t kept = 0; kept <= last.size(); ++kept) {
        write_bytes_to(path, first + last.substr(0, kept));
        EXPECT_EQ(Journal::read(path), complete) << kept;
        Journal journal(path);
        EXPECT_EQ(journal.found(), complete) << kept;
        EXPECT_EQ(read_bytes_of(path), first) << kept;
        journal.append({{"run", "c"}});
        EXPECT_EQ(read_bytes_of(path), first + "{\"run\":\"c\"}\n") << kept;
    }
}

TEST(Journal, ReadingLeavesATornLineAlone) {
    const TemporaryFolder folder;
    const std::string text = "{\"run\":\"a\"}\n{\"run\"";
    write_bytes_to(folder / "j.jsonl", text);
    Journal::read(folder / "j.jsonl");
    EXPECT_EQ(read_bytes_of(folder / "j.jsonl"), text);
}

TEST(Journal, OneAtATimeMayWrite) {
    const TemporaryFolder folder;
    const auto path = folder / "j.jsonl";
    {
        Journal journal(path);
        journal.append({{"run", "a"}});
        // flock() locks belong to one opening of a file, so a second opening in this process is
        // refused like one in another process.
        expect_error([&] { Journal second(path); }, {"j.jsonl", "another lamina study"});
        journal.append({{"run", "b"}});
    }
    EXPECT_EQ(Journal(path).found().size(), 2u);
}

TEST(Journal, GarbageIsAnError) {
    const TemporaryFolder folder;
    const auto path = folder / "j.jsonl";
    for (const char* garbage : {"garbage", "[1]", "5", "", "{\"run\":", "\x01\xff"}) {
        const std::string text = std::string("{\"run\":\"a\"}\n") + garbage + "\n";
        write_bytes_to(path, text);
        expect_error([&] { Journal journal(path); }, {"j.jsonl", "line 2"});
        expect_error([&] { Journal::read(path); }, {"j.jsonl", "line 2"});
        EXPECT_EQ(read_bytes_of(path), text);  // a file that lamina did not write is left unchanged
    }
    expect_error([&] { Journal::read(folder / "absent.jsonl"); }, {"absent.jsonl"});
    expect_error([&] { Journal journal(folder / "absent" / "j.jsonl"); }, {"cannot write"});
}

}  // namespace
}  // namespace lamina::study
