// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "base/client.h"
#include "base/profile.h"

namespace lamina {

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
