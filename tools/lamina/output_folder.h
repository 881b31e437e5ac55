// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace lamina {

// Checks the folder that a verb will write into, before it reads, computes or writes anything else.
// Throws UsageError if one of these names in it is a file of `read`, and Error if it is there and
// the verb did not write it (base/output_file.h), unless `force`.
void expect_own_folder(const std::filesystem::path& folder, const std::string& verb,
                       const std::vector<std::string>& names,
                       const std::vector<std::filesystem::path>& read, bool force);

// The help of --force.
inline constexpr const char* force_help =
    "Replace files of the folder that this verb did not write, but never one that it reads";

}  // namespace lamina
