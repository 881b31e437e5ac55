// SPDX-License-Identifier: Apache-2.0
// The corpus of every fuzz target through the target's own function, without libFuzzer: what once
// failed stays mended.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <vector>

#include "fuzz_target.h"
#include "support/temporary_folder.h"

namespace lamina::fuzz {
namespace {

const std::filesystem::path corpus = std::filesystem::path(LAMINA_SOURCE_DIR) / "tests/fuzz/corpus";

std::vector<std::filesystem::path> entries_of(const std::filesystem::path& folder) {
    const std::filesystem::directory_iterator first(folder);
    std::vector<std::filesystem::path> entries(begin(first), end(first));
    std::ranges::sort(entries);
    return entries;
}

class Replay : public testing::TestWithParam<FuzzTarget> {};

TEST_P(Replay, EveryInputOfTheCorpusIsReadOrRefused) {
    const auto inputs = entries_of(corpus / GetParam().name);
    ASSERT_FALSE(inputs.empty());
    for (const auto& input : inputs) {
        SCOPED_TRACE(input.filename().string());
        const std::string bytes = read_bytes_of(input);
        EXPECT_FALSE(bytes.empty());
        EXPECT_NO_THROW(GetParam().run(bytes));
    }
}

INSTANTIATE_TEST_SUITE_P(, Replay, testing::ValuesIn(fuzz_targets()),
                         [](const auto& each) { return std::string(each.param.name); });

TEST(Corpus, HasAFolderForEachTargetAndNoOther) {
    std::set<std::string> folders, targets;
    for (const auto& folder : entries_of(corpus)) folders.insert(folder.filename());
    for (const FuzzTarget& target : fuzz_targets()) targets.insert(target.name);
    EXPECT_EQ(folders, targets);
}

}  // namespace
}  // namespace lamina::fuzz
