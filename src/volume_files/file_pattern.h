// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lamina {

// A file name with a number in it, as "slice%03d.raw" says.
struct FilePattern {
    std::string before, after;
    int width = 0;  // digits at least, filled up with zeros
};

// Nothing where there is not exactly one %d, %3d or %03d, or any other '%'.
std::optional<FilePattern> file_pattern(std::string_view text);

constexpr std::int64_t most_pattern_files = 100000;

// The names with the numbers from `first` to `last`. Nothing where the step does not lead there, or
// to more than most_pattern_files.
std::optional<std::vector<std::string>> names_of(const FilePattern& pattern, std::int64_t first,
                                                 std::int64_t last, std::int64_t step);

}  // namespace lamina
