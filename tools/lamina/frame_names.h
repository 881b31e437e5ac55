// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace lamina {

// File names of a series, made from a pattern whose last part has one number: %d, or %04d for four
// digits with leading zeros. %% is a percent sign.
class FrameNames {
  public:
    explicit FrameNames(const std::string& pattern);  // throws UsageError

    const std::filesystem::path& folder() const { return folder_; }
    // In the folder: of a frame, and of what is recorded of the series.
    std::string name(int frame) const;
    // `series`: the kind of the series as a word.
    std::string record_name(const char* series) const;

  private:
    std::filesystem::path folder_;
    std::string before_, after_;  // the number
    int digits_ = 0;
};

}  // namespace lamina
