// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

namespace lamina::study {

// Records of a study as it runs, a line of JSON each, on the disk before append() returns: whatever
// ends the program loses nothing but the record that was being written.
class Journal {
  public:
    // Opens the file, or makes it; a last line that is not complete is taken away. Throws Error,
    // also where another process has it open.
    explicit Journal(std::filesystem::path path);
    ~Journal();
    Journal(const Journal&) = delete;
    Journal& operator=(const Journal&) = delete;

    void append(const nlohmann::ordered_json& record);
    // What stood in the file when it was opened.
    const std::vector<nlohmann::json>& found() const { return found_; }

    // All complete records of a journal.
    static std::vector<nlohmann::json> read(const std::filesystem::path& path);

  private:
    std::filesystem::path path_;
    int descriptor_ = -1;
    std::vector<nlohmann::json> found_;
};

}  // namespace lamina::study
