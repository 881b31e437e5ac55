// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace lamina {

// Throws Error if the path is a folder: one line that says so and what is in it. To be called when
// the path is known to be no volume.
void expect_no_folder(const std::filesystem::path& path);

}  // namespace lamina
