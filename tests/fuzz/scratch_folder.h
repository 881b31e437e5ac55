// SPDX-License-Identifier: Apache-2.0
#pragma once

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

}  // namespace lamina::fuzz
