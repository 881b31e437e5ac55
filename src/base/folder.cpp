// SPDX-License-Identifier: Apache-2.0
#include "base/folder.h"

#include "base/error.h"

namespace lamina {

void make_folder(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) fail("{}: cannot make this folder: {}", folder.string(), error.message());
}

}  // namespace lamina
