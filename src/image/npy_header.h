// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace lamina {

constexpr std::string_view npy_magic = "\x93NUMPY";

// The header of a file in NumPy's format (NEP 1): the literal of a Python dictionary. Throws Error
// for what cannot be read as one.
class NpyHeader {
  public:
    explicit NpyHeader(const std::filesystem::path& path);

    std::string descr() const;  // "<f4"; empty where it is no string
    bool is_fortran_order() const;
    std::vector<std::int64_t> shape() const;  // empty where it is no tuple of whole numbers
    std::int64_t data_offset() const { return data_offset_; }

    // Throws the Error that tells what was found under a key.
    [[noreturn]] void wrong(const char* key, std::string_view expected) const;

  private:
    std::string_view value(std::string_view key) const;  // what follows the key

    std::string name_;  // of the file
    std::string text_;
    std::int64_t data_offset_ = 0;
};

}  // namespace lamina
