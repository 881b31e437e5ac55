// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace lamina {

// Which files of a folder a verb wrote itself and may replace. The folder says so in
// lamina-files.txt: a line "VERB: NAME" a file.
class OwnFiles {
  public:
    static constexpr const char* list_name = "lamina-files.txt";

    OwnFiles(std::filesystem::path folder, std::string verb);

    // Throws Error where a file or folder of these names is there that the verb did not write.
    void expect_own(const std::vector<std::string>& names) const;
    // Puts them on the list, before they are written: what is there without being on it is
    // somebody else's, whenever a run is stopped. Makes the folder if need be.
    void add(const std::vector<std::string>& names) const;

  private:
    std::set<std::string> listed() const;  // lines

    std::filesystem::path folder_;
    std::string verb_;
};

}  // namespace lamina
