// SPDX-License-Identifier: Apache-2.0
#include "mesh_files/vtk_tokens.h"

#include <algorithm>
#include <array>
#include <charconv>

#include "base/error.h"

namespace lamina {
namespace {

std::string lower(std::string_view text) {
    std::string result(text);
    for (char& c : result) {
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    }
    return result;
}

// vtkDataReader::ReadArray; VTK writes its vtkIdType as an int.
struct NamedType {
    std::string_view name;
    VtkType type;
};
constexpr auto number = VtkType::Kind::number;
constexpr std::array<NamedType, 18> named_types{{
    {"bit", {VtkType::Kind::bit, ValueType::uint8}},
    {"string", {VtkType::Kind::string, ValueType::uint8}},
    {"utf8_string", {VtkType::Kind::string, ValueType::uint8}},
    {"char", {number, ValueType::int8}},
    {"signed_char", {number, ValueType::int8}},
    {"unsigned_char", {number, ValueType::uint8}},
    {"short", {number, ValueType::int16}},
    {"unsigned_short", {number, ValueType::uint16}},
    {"int", {number, ValueType::int32}},
    {"unsigned_int", {number, ValueType::uint32}},
    {"long", {number, ValueType::int64}},
    {"unsigned_long", {number, ValueType::uint64}},
    {"vtkidtype", {number, ValueType::int32}},
    {"vtktypeint64", {number, ValueType::int64}},
    {"vtktypeuint64", {number, ValueType::uint64}},
    {"vtktypeint32", {number, ValueType::int32}},
    {"float", {number, ValueType::float32}},
    {"double", {number, ValueType::float64}},
}};

}  // namespace

std::string VtkTokens::where() const {
    if (binary_) return fmt::format("{}: byte {}", file_, reader_.position());
    return fmt::format("{}: line {}", file_, reader_.line_number());
}

std::string VtkTokens::keyword() {
    constexpr std::size_t longest = 40;  // keywords are shorter: longer words are binary data
    return lower(reader_.word().substr(0, longest));
}

std::string VtkTokens::name() {
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

std::int64_t VtkTokens::count(const char* what) {
    std::int64_t count = 0;
    TextReader before = reader_;
    if (!reader_.read(count) || count < 0) {
        fail("{}: {}: found {}, expected a whole number >= 0", where(), what, next_word(before));
    }
    return count;
}

std::int64_t VtkTokens::count_in_line(std::int64_t otherwise) {
    return reader_.line_goes_on() ? count("number of components") : otherwise;
}

VtkType VtkTokens::type() {
    TextReader before = reader_;
    const std::string name = keyword();
    const auto found = std::ranges::find(named_types, name, &NamedType::name);
    if (found == named_types.end()) {
        fail("{}: found {}, expected a type of numbers (float, double, int, ...)", where(),
             next_word(before));
    }
    return found->type;
}

const char* VtkTokens::take(std::int64_t count, std::size_t size, const std::string& what) {
    reader_.line();
    if (static_cast<std::uint64_t>(count) > reader_.left() / size) {
        fail("{}: found {} bytes before the end of the file, expected {} numbers of {} bytes", what,
             reader_.left(), count, size);
    }
    const char* const bytes = reader_.here();
    reader_.skip(static_cast<std::size_t>(count) * size);
    return bytes;
}

void VtkTokens::skip_values(VtkType type, std::int64_t count, const std::string& what) {
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

// vtkDataWriter writes one string a line. In binary files each follows its length, which takes 1,
// 2, 4 or 8 bytes as its two highest bits say.
void VtkTokens::skip_strings(std::int64_t count, const std::string& what) {
    reader_.line();
    for (std::int64_t i = 0; i < count; ++i) {
        if (reader_.left() == 0) {
            fail("{}: found {} strings before the end of the file, expected {}", what, i, count);
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

void VtkTokens::skip_metadata() {
    reader_.line();
    while (reader_.left() > 0) {
        TextReader line(reader_.line());
        if (line.at_end()) return;
    }
}

}  // namespace lamina
