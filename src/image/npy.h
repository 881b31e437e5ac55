// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <istream>
#include <string>
#include <string_view>
#include <vector>

#include "base/output_file.h"
#include "lamina/image.h"

namespace lamina {

constexpr std::string_view npy_magic = "\x93NUMPY";

// The header of a NumPy file (NEP 1): a Python dictionary. Throws Error if there is none.
class NpyHeader {
  public:
    explicit NpyHeader(const std::filesystem::path& path);
    // Reads it from a stream. `name`: for messages.
    NpyHeader(std::string name, std::istream& stream);

    std::string descr() const;  // type of the elements, as "<f4"; empty if the value is no string
    bool is_fortran_order() const;
    std::vector<std::int64_t> shape() const;  // empty if it is no tuple of whole numbers
    std::int64_t data_offset() const { return data_offset_; }

    // Throws Error about the value of a key, which says what was found and what was expected.
    [[noreturn]] void wrong(const char* key, std::string_view expected) const;

  private:
    void read(std::istream& stream);
    std::string_view value(std::string_view key) const;  // the text of the value

    std::string name_;  // name of the file
    std::string text_;
    std::int64_t data_offset_ = 0;
};

// Writes NumPy's format 1.0 (NEP 1), little-endian, C order, shape (height, width, 4), in the
// image's own type. Throws Error as write_exr() does. The caller commits the file.
template <typename Real>
void write_npy(OutputFile& file, const RgbaImage<Real>& image);

// Reads '<f4' or '<f8' in C order with shape (height, width, 4), or (height, width, 3) with A = 1.
// Throws Error for anything else, and if the file's length does not match the header.
PreciseImage read_npy(const std::filesystem::path& path);

}  // namespace lamina
