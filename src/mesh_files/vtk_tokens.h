// SPDX-License-Identifier: Apache-2.0
// Tokens, headers and attributes, which legacy VTK files of meshes and of images have in common:
// "VTK File Formats" (the VTK User's Guide) and, for what it does not say, vtkDataReader.cxx.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/value_type.h"
#include "mesh_files/text_reader.h"

namespace lamina {

// The types of arrays in legacy VTK files. Bits and strings are skipped.
struct VtkType {
    enum class Kind { number, bit, string } kind = Kind::number;
    ValueType value = ValueType::float32;
};

inline std::string vtk_lower(std::string_view text) {
    std::string result(text);
    for (char& c : result) {
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    }
    return result;
}

// The names of types, from vtkDataReader::ReadArray. VTK writes its vtkIdType as an int.
struct VtkNamedType {
    std::string_view name;
    VtkType type;
};
constexpr auto of_numbers = VtkType::Kind::number;
inline constexpr std::array<VtkNamedType, 18> vtk_types{{
    {"bit", {VtkType::Kind::bit, ValueType::uint8}},
    {"string", {VtkType::Kind::string, ValueType::uint8}},
    {"utf8_string", {VtkType::Kind::string, ValueType::uint8}},
    {"char", {of_numbers, ValueType::int8}},
    {"signed_char", {of_numbers, ValueType::int8}},
    {"unsigned_char", {of_numbers, ValueType::uint8}},
    {"short", {of_numbers, ValueType::int16}},
    {"unsigned_short", {of_numbers, ValueType::uint16}},
    {"int", {of_numbers, ValueType::int32}},
    {"unsigned_int", {of_numbers, ValueType::uint32}},
    {"long", {of_numbers, ValueType::int64}},
    {"unsigned_long", {of_numbers, ValueType::uint64}},
    {"vtkidtype", {of_numbers, ValueType::int32}},
    {"vtktypeint64", {of_numbers, ValueType::int64}},
    {"vtktypeuint64", {of_numbers, ValueType::uint64}},
    {"vtktypeint32", {of_numbers, ValueType::int32}},
    {"float", {of_numbers, ValueType::float32}},
    {"double", {of_numbers, ValueType::float64}},
}};

inline std::string printable(const std::string& word) {
    std::string text;
    for (const char c : word) text += c >= ' ' && c <= '~' ? c : '?';
    return text;
}

// Reads words, numbers and arrays of a legacy VTK file. Throws Error with the position (where()).
class VtkTokens {
  public:
    VtkTokens(std::string file, std::string_view text) : file_(std::move(file)), reader_(text) {}

    const std::string& file() const { return file_; }
    std::string_view line() { return reader_.line(); }
    void set_binary(bool binary) { binary_ = binary; }
    bool is_binary() const { return binary_; }

    // Returns "FILE: line 12" or "FILE: byte 345".
    std::string where() const {
        if (binary_) return fmt::format("{}: byte {}", file_, reader_.position());
        return fmt::format("{}: line {}", file_, reader_.line_number());
    }

    // Returns the next word in lower case; empty at the end.
    std::string keyword() {
        constexpr std::size_t longest = 40;  // keywords are shorter: longer words are binary data
        return vtk_lower(reader_.word().substr(0, longest));
    }

    // Returns the name of an array, with %20 and the like decoded.
    std::string name() {
        const std::string_view coded = reader_.word();
        if (coded.empty()) fail("{}: found the end, expected the name of an array", where());
        std::string name;
        for (std::size_t i = 0; i < coded.size(); ++i) {
            unsigned char code = 0;
            const char* const hex = coded.data() + i + 1;
            if (coded[i] == '%' && i + 2 < coded.size() &&
                std::from_chars(hex, hex + 2, code, 16).ptr == hex + 2) {
                name += static_cast<char>(code);
                i += 2;
            } else {
                name += coded[i];
            }
        }
        return one_line(name);
    }

    // Returns a whole number >= 0.
    std::int64_t count(const char* what) {
        std::int64_t count = 0;
        TextReader before = reader_;
        if (!reader_.read(count) || count < 0) {
            fail("{}: {}: found {}, expected a whole number >= 0", where(), what,
                 next_word(before));
        }
        return count;
    }

    double number(const char* what) {
        double number = 0;
        TextReader before = reader_;
        if (!reader_.read(number))
            fail("{}: {}: found {}, expected a number", where(), what, next_word(before));
        return number;
    }

    // Reads a number of components if the line has more words, else returns `otherwise`.
    std::int64_t count_in_line(std::int64_t otherwise) {
        return reader_.line_goes_on() ? count("number of components") : otherwise;
    }

    VtkType type() {
        TextReader before = reader_;
        const std::string name = keyword();
        const auto found = std::ranges::find(vtk_types, name, &VtkNamedType::name);
        if (found == vtk_types.end()) {
            fail("{}: found {}, expected a type of numbers (float, double, int, ...)", where(),
                 next_word(before));
        }
        return found->type;
    }

    // Reads `count` numbers. In a binary file they begin on the next line and are big endian.
    template <typename To>
    std::vector<To> values(ValueType type, std::int64_t count, const std::string& what) {
        const std::string place = file_ + ": " + what;
        if (!binary_) return read_text_values<To>(reader_, type, count, place);
        const char* const bytes = take(count, bytes_of(type), place);
        return values_from_bytes<To>(type, bytes, static_cast<std::size_t>(count),
                                     std::endian::native == std::endian::little);
    }

    // Returns a product of counts. Throws Error if it overflows.
    std::int64_t product(std::int64_t a, std::int64_t b, const std::string& what) const {
        std::int64_t result = 0;
        if (__builtin_mul_overflow(a, b, &result)) {
            fail("{}: {}: found {} times {} numbers, more than any file holds", where(), what, a,
                 b);
        }
        return result;
    }

    void skip_values(VtkType type, std::int64_t count, const std::string& what) {
        const std::string place = file_ + ": " + what;
        if (type.kind == VtkType::Kind::string) {
            skip_strings(count, place);
        } else if (!binary_) {
            for (std::int64_t i = 0; i < count; ++i) {
                if (reader_.word().empty()) {
                    fail("{}: found {} values before the end of the file, expected {}", place, i,
                         count);
                }
            }
        } else if (type.kind == VtkType::Kind::bit) {
            take(count / 8 + (count % 8 != 0 ? 1 : 0), 1, place);
        } else {
            take(count, bytes_of(type.value), place);
        }
    }

    // Skips the lines of a METADATA section, which ends with an empty one.
    void skip_metadata() {
        reader_.line();
        while (reader_.left() > 0) {
            TextReader line(reader_.line());
            if (line.at_end()) return;
        }
    }

    // Takes `count` binary values of `size` bytes, which begin on the next line.
    const char* take(std::int64_t count, std::size_t size, const std::string& what) {
        reader_.line();
        if (static_cast<std::uint64_t>(count) > reader_.left() / size) {
            fail("{}: found {} bytes before the end of the file, expected {} numbers of {} bytes",
                 what, reader_.left(), count, size);
        }
        const char* const bytes = reader_.here();
        reader_.skip(static_cast<std::size_t>(count) * size);
        return bytes;
    }

  private:
    // Skips strings, which vtkDataWriter writes one a line. In binary files each follows its
    // length, which takes 1, 2, 4 or 8 bytes as its two highest bits say.
    void skip_strings(std::int64_t count, const std::string& what) {
        reader_.line();
        for (std::int64_t i = 0; i < count; ++i) {
            if (reader_.left() == 0) {
                fail("{}: found {} strings before the end of the file, expected {}", what, i,
                     count);
            }
            if (!binary_) {
                reader_.line();
                continue;
            }
            const auto first = static_cast<unsigned char>(*reader_.here());
            const std::size_t prefix = std::size_t{1} << (3 - (first >> 6));
            std::uint64_t length = first & 63;
            for (std::size_t j = 1; j < std::min(prefix, reader_.left()); ++j) {
                length = length << 8 | static_cast<unsigned char>(reader_.here()[j]);
            }
            if (prefix > reader_.left() || length > reader_.left() - prefix) {
                fail("{}: string {} goes beyond the end of the file", what, i + 1);
            }
            reader_.skip(prefix + length);
        }
    }

    std::string file_;
    TextReader reader_;
    bool binary_ = false;
};

// The keyword of an attribute and its number of components; 0: its line gives it.
struct VtkAttribute {
    std::string_view keyword;
    std::int64_t components;
};
inline constexpr VtkAttribute vtk_attributes[] = {
    {"vectors", 3},    {"normals", 3},      {"tensors", 9},    {"tensors6", 6},
    {"global_ids", 1}, {"pedigree_ids", 1}, {"edge_flags", 1}, {"texture_coordinates", 0},
    {"scalars", 0}};

// The first lines of a legacy VTK file.
struct VtkHeader {
    double version = 0;
    bool binary = false;
    std::string dataset;  // "unstructured_grid", "structured_points", ...
};

// Reads up to the kind of the dataset. The caller sets whether the tokens are binary. Throws Error.
inline VtkHeader read_vtk_header(VtkTokens& tokens) {
    VtkHeader header;
    const std::string_view magic = tokens.line();
    constexpr std::string_view expected = "# vtk DataFile Version ";
    if (!magic.starts_with(expected)) {
        fail("{}: not a legacy VTK file: it does not begin with '{}'", tokens.file(), expected);
    }
    TextReader version(magic.substr(expected.size()));
    if (!version.read(header.version) || !(header.version >= 1 && header.version < 6)) {
        fail("{}: version: found {}, expected 1.0 to 5.1", tokens.file(),
             next_word(TextReader(magic.substr(expected.size()))));
    }
    tokens.line();  // the title
    const std::string coding = tokens.keyword();
    if (coding != "ascii" && coding != "binary")
        fail("{}: line 3: found '{}', expected ASCII or BINARY", tokens.file(), one_line(coding));
    header.binary = coding == "binary";
    if (const std::string word = tokens.keyword(); word != "dataset")
        fail("{}: found '{}', expected DATASET", tokens.where(), one_line(word));
    header.dataset = one_line(tokens.keyword());
    return header;
}

// An array of a legacy VTK file, whose values follow.
struct VtkArrayLine {
    std::string name;
    std::int64_t components = 1, tuples = 0;
    VtkType type;
    bool colours = false;  // bytes in a binary file, fractions of 1 in an ASCII one
};

// Reads the head of an attribute and calls take(VtkArrayLine), which reads or skips its values.
// Returns false if `word` is no attribute. `tuples`: by POINT_DATA or CELL_DATA.
template <typename Take>
bool read_vtk_attribute(VtkTokens& tokens, const std::string& word, std::int64_t tuples,
                        const Take& take) {
    constexpr VtkType byte{VtkType::Kind::number, ValueType::uint8};
    if (word == "lookup_table") {
        const std::string name = tokens.name();
        tokens.skip_values(byte, tokens.product(tokens.count("LOOKUP_TABLE"), 4, name), name);
        return true;
    }
    if (word == "color_scalars") {
        const std::string name = tokens.name();
        take(VtkArrayLine{name, tokens.count("COLOR_SCALARS"), tuples, byte, true});
        return true;
    }
    for (const VtkAttribute& attribute : vtk_attributes) {
        if (word != attribute.keyword) continue;
        VtkArrayLine array{tokens.name(), attribute.components, tuples, {}, false};
        if (word == "texture_coordinates") array.components = tokens.count("TEXTURE_COORDINATES");
        array.type = tokens.type();
        if (word == "scalars") {  // "[components]", then the line "LOOKUP_TABLE name"
            array.components = tokens.count_in_line(1);
            if (const std::string next = tokens.keyword(); next != "lookup_table") {
                fail("{}: found '{}', expected LOOKUP_TABLE after SCALARS", tokens.where(),
                     printable(next));
            }
            tokens.name();
        }
        take(array);
        return true;
    }
    return false;
}

// Reads the arrays behind FIELD, likewise.
template <typename Take>
void read_vtk_field(VtkTokens& tokens, const Take& take) {
    tokens.name();
    const std::int64_t arrays = tokens.count("FIELD");
    for (std::int64_t i = 0; i < arrays; ++i) {
        std::string name = tokens.name();
        if (name == "METADATA") {  // describes the array before
            tokens.skip_metadata();
            name = tokens.name();
        }
        if (name == "NULL_ARRAY") continue;
        const std::int64_t components = tokens.count("FIELD");
        const std::int64_t tuples = tokens.count("FIELD");
        take(VtkArrayLine{name, components, tuples, tokens.type(), false});
    }
}

}  // namespace lamina
