// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

namespace lamina {

// Throws UsageError if a file that a command writes is one that it reads, or is written twice:
// by the same name or another, through a link, or as another name of the same bytes on the disk.
// Empty paths are passed over; "-" is stdout, which can be written once.
void expect_different_files(const std::vector<std::filesystem::path>& read,
                            const std::vector<std::filesystem::path>& written);

}  // namespace lamina
