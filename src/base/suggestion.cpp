// SPDX-License-Identifier: Apache-2.0
#include "base/suggestion.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

namespace lamina {
namespace {

// Levenshtein distance.
std::size_t edit_distance(const std::string& a, const std::string& b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), 0);
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = std::exchange(row[0], i + 1);
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
            diagonal = row[j + 1];
            row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
        }
    }
    return row.back();
}

}  // namespace

std::string suggestion(const std::set<std::string>& words, const std::string& word) {
    if (words.empty()) return "";
    const auto distance = [&](const std::string& known) { return edit_distance(known, word); };
    const std::string& nearest = *std::ranges::min_element(words, {}, distance);
    if (distance(nearest) <= std::max<std::size_t>(2, word.size() / 3)) {
        return fmt::format(", did you mean \"{}\"?", nearest);
    }
    return fmt::format(", expected one of {}", fmt::join(words, ", "));
}

}  // namespace lamina
