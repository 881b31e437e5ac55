// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/value_type.h"
#include "mesh_files/text_reader.h"

namespace lamina {

// The types of arrays in legacy VTK files. Bits and strings are skipped.
struct VtkType {
    enum class Kind { number, bit, string } kind = Kind::number;
    ValueType value = ValueType::float32;
};

// Reads words, numbers and arrays of a legacy VTK file. Throws Error. Messages name the file and
// the position: a line of an ASCII file, a byte of a binary one.
class VtkTokens {
  public:
    VtkTokens(std::string file, std::string_view text) : file_(std::move(file)), reader_(text) {}

    const std::string& file() const { return file_; }
    std::string_view line() { return reader_.line(); }
    void set_binary(bool binary) { binary_ = binary; }

    std::string where() const;             // "FILE: line 12" or "FILE: byte 345"
    std::string keyword();                 // the next word in lower case; empty at the end
    std::string name();                    // name of an array, with %20 and the like decoded
    std::int64_t count(const char* what);  // a whole number >= 0
    // The same where the line has more words, else `otherwise`.
    std::int64_t count_in_line(std::int64_t otherwise);
    VtkType type();

    // Reads `count` numbers. In a binary file they begin on the next line and are big endian.
    template <typename To>
    std::vector<To> values(ValueType type, std::int64_t count, const std::string& what) {
        const std::string place = file_ + ": " + what;
        if (!binary_) return read_text_values<To>(reader_, type, count, place);
        const char* const bytes = take(count, bytes_of(type), place);
        return values_from_bytes<To>(type, bytes, static_cast<std::size_t>(count),
                                     std::endian::native == std::endian::little);
    }
    void skip_values(VtkType type, std::int64_t count, const std::string& what);
    void skip_metadata();  // skips the lines up to an empty one

  private:
    const char* take(std::int64_t count, std::size_t size, const std::string& what);
    void skip_strings(std::int64_t count, const std::string& what);

    std::string file_;
    TextReader reader_;
    bool binary_ = false;
};

}  // namespace lamina
