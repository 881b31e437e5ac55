// SPDX-License-Identifier: Apache-2.0
// Passes the corpus of every fuzz target to the target's function, without libFuzzer, so that
// inputs that once failed do not fail again.
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "corpus_folder.h"
#include "support/temporary_folder.h"

namespace lamina::fuzz {
namespace {

class Replay : public testing::TestWithParam<FuzzTarget> {};

TEST_P(Replay, EveryInputOfTheCorpusIsReadOrRefused) {
    const auto inputs = entries_of(corpus_folder / GetParam().name);
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
    for (const auto& folder : entries_of(corpus_folder)) folders.insert(folder.filename());
    for (const FuzzTarget& target : fuzz_targets()) targets.insert(target.name);
    EXPECT_EQ(folders, targets);
}

}  // namespace
}  // namespace lamina::fuzz
