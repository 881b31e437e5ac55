// SPDX-License-Identifier: Apache-2.0
#include "scratch_folder.h"

#include <fstream>

#include "support/temporary_folder.h"
#include "violation.h"

namespace lamina::fuzz {

std::filesystem::path scratch_folder() {
    static const TemporaryFolder folder;
    return folder.path();
}

std::filesystem::path scratch_file(const std::string& name, std::string_view bytes) {
    const std::filesystem::path path = scratch_folder() / name;
    std::ofstream stream(path, std::ios::binary);
    stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    stream.close();
    if (!stream) throw std::runtime_error("cannot write " + path.string());
    return path;
}

}  // namespace lamina::fuzz
