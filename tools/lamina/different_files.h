// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace lamina {

// Throws UsageError where two of these are one file, by the same name or another, or through a
// link: what is read must not be replaced by what is written. Empty ones are passed over. `roles`:
// what they are, for the message.
void expect_different_files(const std::vector<std::filesystem::path>& files,
                            const std::string& roles);

}  // namespace lamina
