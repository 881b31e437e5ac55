// SPDX-License-Identifier: Apache-2.0
// "VTK File Formats" (the VTK User's Guide) and, for what it does not say, vtkDataReader.cxx.
#include "mesh_files/mesh_formats.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <string>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "base/input_file.h"
#include "base/value_type.h"
#include "mesh_files/mesh_assembly.h"
#include "mesh_files/text_reader.h"

namespace lamina {
namespace {

// The types of arrays in legacy VTK files. Bits and strings are skipped.
struct VtkType {
    enum class Kind { number, bit, string } kind = Kind::number;
    ValueType value = ValueType::float32;
};

std::string lower(std::string_view text) {
    std::string result(text);
    for (char& c : result) {
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    }
    return result;
}

// The names of types, from vtkDataReader::ReadArray. VTK writes its vtkIdType as an int.
struct NamedType {
    std::string_view name;
    VtkType type;
};
constexpr auto of_numbers = VtkType::Kind::number;
constexpr std::array<NamedType, 18> named_types{{
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

// Reads words, numbers and arrays of a legacy VTK file. Throws Error with the position (where()).
class VtkTokens {
  public:
    VtkTokens(std::string file, std::string_view text) : file_(std::move(file)), reader_(text) {}

    const std::string& file() const { return file_; }
    std::string_view line() { return reader_.line(); }
    void set_binary(bool binary) { binary_ = binary; }

    // Returns "FILE: line 12" or "FILE: byte 345".
    std::string where() const {
        if (binary_) return fmt::format("{}: byte {}", file_, reader_.position());
        return fmt::format("{}: line {}", file_, reader_.line_number());
    }

    // Returns the next word in lower case; empty at the end.
    std::string keyword() {
        constexpr std::size_t longest = 40;  // keywords are shorter: longer words are binary data
        return lower(reader_.word().substr(0, longest));
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

    // Reads a number of components if the line has more words, else returns `otherwise`.
    std::int64_t count_in_line(std::int64_t otherwise) {
        return reader_.line_goes_on() ? count("number of components") : otherwise;
    }

    VtkType type() {
        TextReader before = reader_;
        const std::string name = keyword();
        const auto found = std::ranges::find(named_types, name, &NamedType::name);
        if (found == named_types.end()) {
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

  private:
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
struct Attribute {
    std::string_view keyword;
    std::int64_t components;
};
constexpr Attribute attributes[] = {
    {"vectors", 3},    {"normals", 3},      {"tensors", 9},    {"tensors6", 6},
    {"global_ids", 1}, {"pedigree_ids", 1}, {"edge_flags", 1}, {"texture_coordinates", 0},
    {"scalars", 0}};

class VtkReader {
  public:
    VtkReader(const std::string& file, std::string_view text) : tokens_(file, text) {
        piece_.label = file;
    }

    MeshPiece read() {
        read_header();
        for (std::string word = tokens_.keyword(); !word.empty(); word = tokens_.keyword()) {
            read_section(word);
        }
        if (!has_points_) fail("{}: no POINTS in it", tokens_.file());
        if (!has_cells_) fail("{}: no CELLS in it", tokens_.file());
        if (!has_types_) fail("{}: no CELL_TYPES in it", tokens_.file());
        check_count("CELL_TYPES", piece_.cells.types.size(), piece_.cells.ends.size());
        for (const MeshScalar& scalar : piece_.point_scalars) {
            check_count("POINT_DATA", scalar.values.size(), piece_.points.size());
        }
        for (const MeshScalar& scalar : piece_.cell_scalars) {
            check_count("CELL_DATA", scalar.values.size(), piece_.cells.ends.size());
        }
        return std::move(piece_);
    }

  private:
    void check_count(const char* what, std::size_t found, std::size_t expected) {
        if (found == expected) return;
        fail("{}: {}: found {} values, expected {}, as many as there are {}", tokens_.file(), what,
             found, expected, std::string_view(what) == "POINT_DATA" ? "points" : "cells");
    }

    void read_header() {
        const std::string_view magic = tokens_.line();
        constexpr std::string_view expected = "# vtk DataFile Version ";
        if (!magic.starts_with(expected)) {
            fail("{}: not a legacy VTK file: it does not begin with '{}'", tokens_.file(),
                 expected);
        }
        TextReader version(magic.substr(expected.size()));
        double number = 0;
        if (!version.read(number) || !(number >= 1 && number < 6)) {
            fail("{}: version: found {}, expected 1.0 to 5.1", tokens_.file(),
                 next_word(TextReader(magic.substr(expected.size()))));
        }
        offsets_and_connectivity_ = number >= 5;
        tokens_.line();  // the title
        const std::string coding = tokens_.keyword();
        if (coding != "ascii" && coding != "binary") {
            fail("{}: line 3: found '{}', expected ASCII or BINARY", tokens_.file(),
                 one_line(coding));
        }
        const std::string dataset = tokens_.keyword();
        const std::string kind = tokens_.keyword();
        if (dataset != "dataset" || kind != "unstructured_grid") {
            fail("{}: found '{} {}', expected 'DATASET UNSTRUCTURED_GRID'", tokens_.where(),
                 one_line(dataset), one_line(kind));
        }
        tokens_.set_binary(coding == "binary");
    }

    void read_section(const std::string& word) {
        if (word == "points") {
            read_points();
        } else if (word == "cells") {
            read_cells();
        } else if (word == "cell_types") {
            once(has_types_, "CELL_TYPES");
            const std::int64_t count = tokens_.count("CELL_TYPES");
            piece_.cells.types =
                tokens_.values<std::int64_t>(ValueType::int32, count, "CELL_TYPES");
        } else if (word == "point_data" || word == "cell_data") {
            data_ = word == "point_data" ? Data::point : Data::cell;
            tuples_ = tokens_.count(data_ == Data::point ? "POINT_DATA" : "CELL_DATA");
        } else if (word == "field") {
            read_field();
        } else if (word == "metadata") {
            tokens_.skip_metadata();
        } else if (data_ == Data::none || !read_attribute(word)) {
            fail("{}: found '{}', expected a keyword (POINTS, CELLS, SCALARS, ...)",
                 tokens_.where(), printable(word));
        }
    }

    static std::string printable(const std::string& word) {
        std::string text;
        for (const char c : word) text += c >= ' ' && c <= '~' ? c : '?';
        return text;
    }

    void once(bool& seen, const char* section) {
        if (seen) fail("{}: a second {}, expected one", tokens_.where(), section);
        seen = true;
    }

    std::int64_t product(std::int64_t a, std::int64_t b, const std::string& what) {
        std::int64_t result = 0;
        if (__builtin_mul_overflow(a, b, &result)) {
            fail("{}: {}: found {} times {} numbers, more than any file holds", tokens_.where(),
                 what, a, b);
        }
        return result;
    }

    ValueType number_type(const char* what) {
        const VtkType type = tokens_.type();
        if (type.kind != VtkType::Kind::number) {
            fail("{}: {}: expected a type of numbers", tokens_.where(), what);
        }
        return type.value;
    }

    void read_points() {
        once(has_points_, "POINTS");
        const std::int64_t count = product(tokens_.count("POINTS"), 3, "POINTS");
        const ValueType type = number_type("POINTS");
        piece_.points = points_from_values(tokens_.values<double>(type, count, "POINTS"));
    }

    void read_cells() {
        once(has_cells_, "CELLS");
        const std::int64_t count = tokens_.count("CELLS");
        const std::int64_t size = tokens_.count("CELLS");
        if (offsets_and_connectivity_) {
            std::vector<std::int64_t> offsets = read_indices("OFFSETS", count);
            piece_.cells.connectivity = read_indices("CONNECTIVITY", size);
            if (offsets.empty()) return;
            if (offsets[0] != 0) {
                fail("{}: OFFSETS: found {} at the first, expected 0", tokens_.file(), offsets[0]);
            }
            offsets.erase(offsets.begin());
            piece_.cells.ends = std::move(offsets);
            return;
        }
        unpack_cells(count, tokens_.values<std::int64_t>(ValueType::int32, size, "CELLS"));
    }

    std::vector<std::int64_t> read_indices(const char* section, std::int64_t count) {
        const std::string word = tokens_.keyword();
        if (word != (std::string_view(section) == "OFFSETS" ? "offsets" : "connectivity")) {
            fail("{}: found '{}', expected {}", tokens_.where(), printable(word), section);
        }
        const ValueType type = number_type(section);
        if (!is_integer(type)) fail("{}: {}: expected integers", tokens_.where(), section);
        return tokens_.values<std::int64_t>(type, count, section);
    }

    // Sets the cells by a list of versions below 5: each cell's number of points, then these.
    void unpack_cells(std::int64_t count, const std::vector<std::int64_t>& list) {
        if (static_cast<std::uint64_t>(count) > list.size()) {
            fail("{}: CELLS: found a list of {} numbers for {} cells", tokens_.file(), list.size(),
                 count);
        }
        MeshCells& cells = piece_.cells;
        cells.ends.reserve(static_cast<std::size_t>(count));
        cells.connectivity.reserve(list.size() - static_cast<std::size_t>(count));
        std::size_t at = 0;
        for (std::int64_t cell = 0; cell < count; ++cell) {
            const std::int64_t points = at < list.size() ? list[at] : -1;
            if (points < 0 || static_cast<std::uint64_t>(points) > list.size() - at - 1) {
                fail("{}: CELLS: cell {} (the first is 0) goes beyond the list of {} numbers",
                     tokens_.file(), cell, list.size());
            }
            const auto first = list.begin() + static_cast<std::ptrdiff_t>(at) + 1;
            cells.connectivity.insert(cells.connectivity.end(), first, first + points);
            cells.ends.push_back(static_cast<std::int64_t>(cells.connectivity.size()));
            at += static_cast<std::size_t>(points) + 1;
        }
        if (at != list.size()) {
            fail("{}: CELLS: found {} numbers, its {} cells take {}", tokens_.file(), list.size(),
                 count, at);
        }
    }

    // Returns false if `word` is not an attribute.
    bool read_attribute(const std::string& word) {
        // Colours are bytes in a binary file and fractions in an ASCII one.
        if (const bool table = word == "lookup_table"; table || word == "color_scalars") {
            const std::string name = tokens_.name();
            const std::int64_t each = tokens_.count(table ? "LOOKUP_TABLE" : "COLOR_SCALARS");
            tokens_.skip_values({VtkType::Kind::number, ValueType::uint8},
                                product(each, table ? 4 : tuples_, name), name);
            return true;
        }
        for (const Attribute& attribute : attributes) {
            if (word != attribute.keyword) continue;
            const std::string name = tokens_.name();
            std::int64_t components = attribute.components;
            if (word == "texture_coordinates") components = tokens_.count("TEXTURE_COORDINATES");
            const VtkType type = tokens_.type();
            if (word == "scalars") components = read_scalars_line();
            read_array(name, components, tuples_, type);
            return true;
        }
        return false;
    }

    // Reads "[components]", then the line "LOOKUP_TABLE name".
    std::int64_t read_scalars_line() {
        const std::int64_t components = tokens_.count_in_line(1);
        if (const std::string word = tokens_.keyword(); word != "lookup_table") {
            fail("{}: found '{}', expected LOOKUP_TABLE after SCALARS", tokens_.where(),
                 printable(word));
        }
        tokens_.name();
        return components;
    }

    void read_field() {
        tokens_.name();
        const std::int64_t arrays = tokens_.count("FIELD");
        for (std::int64_t i = 0; i < arrays; ++i) {
            std::string name = tokens_.name();
            if (name == "METADATA") {  // describes the array before
                tokens_.skip_metadata();
                name = tokens_.name();
            }
            if (name == "NULL_ARRAY") continue;
            const std::int64_t components = tokens_.count("FIELD");
            const std::int64_t tuples = tokens_.count("FIELD");
            read_array(name, components, tuples, tokens_.type());
        }
    }

    void read_array(const std::string& name, std::int64_t components, std::int64_t tuples,
                    VtkType type) {
        const std::string what = "'" + name + "'";
        const std::int64_t count = product(components, tuples, what);
        if (data_ == Data::none || !makes_scalar(components) ||
            type.kind != VtkType::Kind::number) {
            tokens_.skip_values(type, count, what);
            return;
        }
        if (tuples != tuples_) {
            fail("{}: {}: found {} values, expected {}", tokens_.where(), what, tuples, tuples_);
        }
        auto& scalars = data_ == Data::point ? piece_.point_scalars : piece_.cell_scalars;
        add_scalars(scalars, name, components, tokens_.values<double>(type.value, count, what));
    }

    enum class Data { none, point, cell };

    VtkTokens tokens_;
    MeshPiece piece_;
    bool offsets_and_connectivity_ = false;
    bool has_points_ = false, has_cells_ = false, has_types_ = false;
    Data data_ = Data::none;
    std::int64_t tuples_ = 0;  // values of each array, by POINT_DATA or CELL_DATA
};

}  // namespace

MeshData read_vtk(const std::filesystem::path& path) {
    const ByteBuffer bytes = read_large_file(path);
    MeshAssembly assembly(path.string());
    assembly.add(VtkReader(path.string(), bytes.text()).read());
    return assembly.finish();
}

}  // namespace lamina
