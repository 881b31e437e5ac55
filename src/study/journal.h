// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

namespace lamina::study {

// Text about a record that lamina did not write.
inline constexpr const char* strange_record =
    "a record lacks a key, or a key has a value of another kind";

// The records of a running study, one line of JSON each. A record is on disk before append()
// returns, so that a crash loses at most the record that was being written.
class Journal {
  public:
    // Opens or makes the file. An incomplete last line is removed. Throws Error, also where another
    // process has the file open.
    explicit Journal(std::filesystem::path path);
    ~Journal();
    Journal(const Journal&) = delete;
    Journal& operator=(const Journal&) = delete;

    void append(const nlohmann::ordered_json& record);
    // The records that the file had when it was opened.
    const std::vector<nlohmann::json>& found() const { return found_; }

    // All complete records of a journal.
    static std::vector<nlohmann::json> read(const std::filesystem::path& path);

  private:
    std::filesystem::path path_;
    int descriptor_ = -1;
    std::vector<nlohmann::json> found_;
};

}  // namespace lamina::study
