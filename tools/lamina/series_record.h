// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "base/client.h"
#include "base/profile.h"

namespace lamina {

// File names of a series, made from a pattern whose file name has one number: %d, or %04d for four
// digits with leading zeros. %% is a percent sign.
class FrameNames {
  public:
    explicit FrameNames(const std::string& pattern);  // throws UsageError

    const std::filesystem::path& folder() const { return folder_; }
    // Returns the name, in the folder, of a frame's picture.
    std::string name(int frame) const;
    // Returns the name of the series' record. `series`: the kind of the series, as a word.
    std::string record_name(const char* series) const;

  private:
    std::filesystem::path folder_;
    std::string before_, after_;  // text before and after the number
    int digits_ = 0;
};

// Returns the thread's client without its stop request, for work that must be finished after a
// stop.
Client finishing_client();

// A file beside a series of pictures that lists, for each of them, hashes of its input and of its
// file. From it a later run learns which pictures exist, intact and made from the same input.
class SeriesRecord {
  public:
    // `key`: hash of the input that all pictures share. A record with another key, or one that
    // cannot be read, counts as empty.
    SeriesRecord(std::filesystem::path file, std::string key);

    // Throws Error if there is a record of another key, or one that cannot be read.
    void expect_match() const;
    // Returns true if the picture exists, unchanged since it was recorded, with the same input.
    bool has(const std::string& name, const std::string& input = "") const;
    // Adds a picture that is written. `input`: hash of the input that only this picture depends on.
    // The record is written at most once a second, and by write().
    void add(const std::string& name, const std::string& input = "");
    void write();

  private:
    std::filesystem::path file_;
    std::string key_;
    bool matches_ = true;
    std::map<std::string, std::string> hashes_;  // "FILE_HASH INPUT_HASH" of each file
    Stopwatch since_written_;
};

}  // namespace lamina
