// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace lamina {

// The header of a MetaImage: lines "Key = value" up to ElementDataFile. Throws Error, which names
// the file, the key, what was found and what was expected.
class MetaImageFields {
  public:
    explicit MetaImageFields(const std::filesystem::path& path);

    const std::string& file() const { return file_; }
    std::int64_t length() const {
        return length_;
    }  // bytes up to the end of ElementDataFile's line
    const std::vector<std::string>& listed() const { return listed_; }  // the lines behind it

    bool has(const std::string& key) const { return fields_.contains(key); }
    std::string text(const std::string& key, const std::string& otherwise = "") const;
    bool flag(const std::string& key, bool otherwise) const;  // True or False
    std::int64_t whole(const std::string& key, std::int64_t least, std::int64_t most) const;
    std::vector<std::int64_t> wholes(const std::string& key, std::size_t count, std::int64_t least,
                                     std::int64_t most) const;
    std::vector<double> numbers(const std::string& key, std::size_t count) const;  // finite

    [[noreturn]] void reject(const std::string& key, const std::string& expected) const;

  private:
    std::string file_;
    std::map<std::string, std::string> fields_;
    std::int64_t length_ = 0;
    std::vector<std::string> listed_;
};

}  // namespace lamina
