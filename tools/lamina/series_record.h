// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "base/client.h"
#include "base/profile.h"

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

// The thread's client without its request to stop, for work on a series after that.
Client finishing_client();

// A file beside a series of pictures that lists them: the input of each, and a hash of each file. A
// later run learns from it which pictures are there, intact, and made from its own input.
class SeriesRecord {
  public:
    // `key`: a hash of all that the pictures depend on. A record of another key, or one that cannot
    // be read, counts as empty.
    SeriesRecord(std::filesystem::path file, std::string key);

    // Returns true if the file is in the record's folder as it was written, from this input.
    bool has(const std::string& name, const std::string& input = "") const;
    // Adds a file that is complete. `input`: a hash of the input that only this file depends on.
    // The record itself is written once a second, and by write().
    void add(const std::string& name, const std::string& input = "");
    void write();

  private:
    std::filesystem::path file_;
    std::string key_;
    std::map<std::string, std::string> hashes_;  // of each file, and of its input behind a blank
    Stopwatch since_written_;
};

}  // namespace lamina
