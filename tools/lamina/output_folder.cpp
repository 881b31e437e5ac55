// SPDX-License-Identifier: Apache-2.0
#include "output_folder.h"

#include "base/output_file.h"
#include "different_files.h"

namespace lamina {

void expect_own_folder(const std::filesystem::path& folder, const std::string& verb,
                       const std::vector<std::string>& names,
                       const std::vector<std::filesystem::path>& read, bool force) {
    std::vector<std::filesystem::path> written{folder / OwnFiles::list_name};
    for (const std::string& name : names) written.push_back(folder / name);
    expect_different_files(read, written);
    if (!force) OwnFiles(folder, verb).expect_own(names);
}

}  // namespace lamina
