// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace lamina {

// The file and the array ("/PATH") of a path "FILE.h5:/PATH". `array` is empty for a plain file.
struct ArrayPath {
    std::filesystem::path file;
    std::string array;
};

ArrayPath array_path(const std::filesystem::path& path);

}  // namespace lamina
