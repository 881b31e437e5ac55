// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace lamina {

// The files of a folder that a verb wrote itself and may therefore replace. They are listed in the
// folder's lamina-files.txt, with a line "VERB: NAME" for each file.
class OwnFiles {
  public:
    static constexpr const char* list_name = "lamina-files.txt";

    OwnFiles(std::filesystem::path folder, std::string verb);

    // Throws Error where a file or folder of these names exists that the verb did not write.
    void expect_own(const std::vector<std::string>& names) const;
    // Adds names to the list before the files are written. So a file that is not on the list
    // belongs to somebody else, even after a run was stopped. Makes the folder where it does not
    // exist.
    void add(const std::vector<std::string>& names) const;

  private:
    std::set<std::string> listed() const;  // lines of the list

    std::filesystem::path folder_;
    std::string verb_;
};

}  // namespace lamina
