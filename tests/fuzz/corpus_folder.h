// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <filesystem>
#include <ostream>
#include <vector>

#include "fuzz_target.h"

namespace lamina::fuzz {

inline const std::filesystem::path corpus_folder =
    std::filesystem::path(LAMINA_SOURCE_DIR) / "tests/fuzz/corpus";

// Lists the files or folders in a folder, sorted.
inline std::vector<std::filesystem::path> entries_of(const std::filesystem::path& folder) {
    const std::filesystem::directory_iterator first(folder);
    std::vector<std::filesystem::path> entries(begin(first), end(first));
    std::ranges::sort(entries);
    return entries;
}

// Lets GoogleTest print a target by its name.
inline void PrintTo(const FuzzTarget& target, std::ostream* stream) {
    *stream << target.name;
}

}  // namespace lamina::fuzz
