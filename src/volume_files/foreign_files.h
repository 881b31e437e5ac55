// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace lamina {

// Throws Error if the path is a file that is empty, or of a format that lamina does not read: one
// line that names the format and says what to do. To be called when the path is known to be no
// scene, volume or mesh by its content. `is_named`: by its name it is one, which may be packed.
void expect_no_foreign_file(const std::filesystem::path& path, bool is_named = false);

// Throws Error if the path is a folder: one line that says so and what is in it. To be called when
// the path is known to be no volume.
void expect_no_folder(const std::filesystem::path& path);

}  // namespace lamina
