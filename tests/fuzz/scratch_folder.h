// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace lamina::fuzz {

// Writes `bytes` to a file of this name in a folder below TMPDIR (tools/fuzz lets that lie in
// memory) which goes when the process ends. The readers take paths.
std::filesystem::path scratch_file(const std::string& name, std::string_view bytes);

std::filesystem::path scratch_folder();

// Whether a file name in an input leads nowhere but into the scratch folder: fuzzing must not read
// other files.
inline bool stays_in_folder(std::string_view name) {
    return name.find_first_of("/$") == name.npos;  // $: ${LAMINA_DATA}
}

}  // namespace lamina::fuzz
