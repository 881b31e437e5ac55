// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <string_view>

namespace lamina::fuzz {

// Writes `bytes` to a file of this name in the scratch folder, for readers that take paths. The
// folder lies below TMPDIR, which tools/fuzz puts in memory, and is removed when the process ends.
std::filesystem::path scratch_file(const std::string& name, std::string_view bytes);

std::filesystem::path scratch_folder();

// Tells whether a file name in an input can only mean a file in the scratch folder: fuzzing must
// not read other files.
inline bool stays_in_folder(std::string_view name) {
    return name.find_first_of("/$") == name.npos;  // $ as in ${LAMINA_DATA}
}

// Tells whether all files that an index (.pvd, .pvtu, .pvti) names are in the scratch folder.
inline bool names_stay_in_folder(std::string_view index) {
    for (const char* const attribute : {"file=\"", "Source=\"", "file='", "Source='"}) {
        for (std::size_t at = index.find(attribute); at != index.npos;
             at = index.find(attribute, at + 1)) {
            const std::size_t from = index.find_first_of("\"'", at) + 1;
            const std::size_t end = std::min(index.find_first_of("\"'", from), index.size());
            if (!stays_in_folder(index.substr(from, end - from))) return false;
        }
    }
    return index.find("&#") == index.npos;  // a character reference, which may stand for a slash
}

}  // namespace lamina::fuzz
