// SPDX-License-Identifier: Apache-2.0
// Fuzzes every target for a short time in the ordinary tests, with FuzzTarget::mutations random
// mutations of its corpus, the same ones every time. tools/fuzz searches longer, guided by
// coverage.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "compositing/codes.h"
#include "corpus_folder.h"
#include "support/temporary_folder.h"

namespace lamina::fuzz {
namespace {

// Texts that readers are likely to handle wrongly: extreme numbers, and marks of syntax.
constexpr std::array<std::string_view, 14> words{
    "0",          "-1",     "4294967296", "18446744073709551615",
    "1e308",      "1e-320", "nan",        "-1e39",
    "2147483647", "65536",  "\"",         "}",
    " ",          "\n"};

// Makes random mutations of the inputs of a corpus.
class Mutator {
  public:
    Mutator(const std::vector<std::string>& corpus, std::uint64_t seed)
        : corpus_(corpus), bits_(seed) {}

    std::string next() {
        std::string input = corpus_[below(corpus_.size())];
        for (std::size_t change = 1 + below(4); change > 0; --change) mutate(input);
        return input;
    }

  private:
    std::size_t below(std::size_t count) { return bits_.next() % count; }

    // Returns a random place in the input, or its end.
    std::size_t place(const std::string& input) { return below(input.size() + 1); }

    void mutate(std::string& input) {
        const std::size_t at = place(input), length = 1 + below(16);
        const std::string_view word = words[below(words.size())];
        const std::string& other = corpus_[below(corpus_.size())];
        switch (below(7)) {
            case 0:
                if (at < input.size()) input[at] = static_cast<char>(input[at] ^ (1 << below(8)));
                break;
            case 1:
                if (at < input.size()) input[at] = static_cast<char>(bits_.next());
                break;
            case 2:
                input.erase(at, length);
                break;
            case 3:
                input.insert(at, input.substr(place(input), length));
                break;
            case 4:
                input.replace(at, std::min(length, input.size() - at), word);
                break;
            case 5:
                input.resize(at);
                break;
            default:
                input = input.substr(0, at) + other.substr(place(other));
        }
    }

    const std::vector<std::string>& corpus_;
    SplitMix64 bits_;
};

class Mutations : public testing::TestWithParam<FuzzTarget> {};

TEST_P(Mutations, AreReadOrRefused) {
    std::vector<std::string> corpus;
    for (const auto& path : entries_of(corpus_folder / GetParam().name))
        corpus.push_back(read_bytes_of(path));
    ASSERT_FALSE(corpus.empty());
    Mutator mutator(corpus, 1);
    for (int i = 0; i < GetParam().mutations; ++i) {
        const std::string input = mutator.next();
        ASSERT_NO_THROW(GetParam().run(input))
            << "input " << i << ": " << testing::PrintToString(input);
    }
}

INSTANTIATE_TEST_SUITE_P(, Mutations, testing::ValuesIn(fuzz_targets()),
                         [](const auto& each) { return std::string(each.param.name); });

}  // namespace
}  // namespace lamina::fuzz
