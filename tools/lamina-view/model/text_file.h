// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace lamina::view {

// Writes a file that appears under its name only when it is complete. Throws Error, and leaves
// nothing behind, if it cannot be written.
void save_text(const std::filesystem::path& file, const std::string& text);

}  // namespace lamina::view
