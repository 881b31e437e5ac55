// SPDX-License-Identifier: Apache-2.0
#include "time_range.h"

#include <fmt/format.h>

#include <charconv>

#include "base/error.h"
#include "base/text.h"

namespace lamina {
namespace {

constexpr std::int64_t largest_number = 1'000'000'000, most_steps = 100'000;

// Whole numbers from 0 with colons between; empty if it is anything else.
std::vector<std::int64_t> numbers_of(const std::string& text) {
    std::vector<std::int64_t> numbers;
    const char* at = text.data();
    const char* const end = at + text.size();
    while (numbers.size() < 4) {
        std::int64_t number = 0;
        const auto [stop, problem] = std::from_chars(at, end, number);
        if (problem != std::errc{} || number < 0 || number > largest_number) return {};
        numbers.push_back(number);
        if (stop == end) return numbers;
        if (*stop != ':') return {};
        at = stop + 1;
    }
    return {};
}

}  // namespace

std::vector<std::int64_t> TimeRange::steps() const {
    std::vector<std::int64_t> all;
    for (std::int64_t at = first; at <= last; at += step) all.push_back(at);
    return all;
}

TimeRange time_range(const std::string& text) {
    const std::vector<std::int64_t> numbers = numbers_of(text);
    TimeRange range;
    const bool good = numbers.size() == 2 || numbers.size() == 3;
    if (good) range = {numbers[0], numbers[1], numbers.size() == 3 ? numbers[2] : 1};
    if (!good || range.last < range.first || range.step < 1) {
        throw UsageError(fmt::format(
            "--time {}: expected FIRST:LAST or FIRST:LAST:STEP, whole numbers as in 0:99:3",
            shortened(text)));
    }
    if ((range.last - range.first) / range.step >= most_steps) {
        throw UsageError(fmt::format("--time {}: found {} steps, expected at most {}", text,
                                     (range.last - range.first) / range.step + 1, most_steps));
    }
    return range;
}

}  // namespace lamina
