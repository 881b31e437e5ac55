// SPDX-License-Identifier: Apache-2.0
// Makes the bytes of mesh files in every encoding, independently of the library.
#pragma once

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "support/test_grid.h"

namespace lamina::testing {

template <typename T>
std::string bytes_as(const std::vector<double>& values, bool big_endian) {
    std::string bytes;
    for (const double value : values) {
        const T stored = static_cast<T>(value);
        char word[sizeof(T)];
        std::memcpy(word, &stored, sizeof(T));  // tests run on little-endian machines only
        if (big_endian) std::reverse(word, word + sizeof(T));
        bytes.append(word, sizeof(T));
    }
    return bytes;
}

inline std::string bytes_of_array(const std::string& type, const std::vector<double>& values,
                                  bool big_endian) {
    if (type == "Int8") return bytes_as<std::int8_t>(values, big_endian);
    if (type == "UInt8") return bytes_as<std::uint8_t>(values, big_endian);
    if (type == "Int16") return bytes_as<std::int16_t>(values, big_endian);
    if (type == "UInt16") return bytes_as<std::uint16_t>(values, big_endian);
    if (type == "Int32") return bytes_as<std::int32_t>(values, big_endian);
    if (type == "UInt32") return bytes_as<std::uint32_t>(values, big_endian);
    if (type == "Int64") return bytes_as<std::int64_t>(values, big_endian);
    if (type == "UInt64") return bytes_as<std::uint64_t>(values, big_endian);
    if (type == "Float32") return bytes_as<float>(values, big_endian);
    return bytes_as<double>(values, big_endian);
}

inline std::string text_of_array(const TestArray& array) {
    std::string text;
    for (std::size_t i = 0; i < array.values.size(); ++i) {
        text += array.type == "Float32" ? fmt::format("{}", static_cast<float>(array.values[i]))
                : array.type == "Float64"
                    ? fmt::format("{}", array.values[i])
                    : fmt::format("{}", static_cast<std::int64_t>(array.values[i]));
        text += i % 7 == 6 ? '\n' : ' ';
    }
    return text;
}

inline std::string base64(const std::string& bytes) {
    static constexpr char digits[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        unsigned bits = 0;
        for (std::size_t j = 0; j < 3; ++j) {
            bits =
                bits << 8 | (i + j < bytes.size() ? static_cast<unsigned char>(bytes[i + j]) : 0);
        }
        for (std::size_t j = 0; j < 4; ++j) {
            text += i + j <= bytes.size() ? digits[bits >> (18 - 6 * j) & 63] : '=';
        }
    }
    return text;
}

inline std::string zlib(const std::string& bytes) {
    uLongf size = compressBound(bytes.size());
    std::string packed(size, '\0');
    compress(reinterpret_cast<Bytef*>(packed.data()), &size,
             reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
    packed.resize(size);
    return packed;
}

struct VtuStyle {
    std::string format = "ascii";  // ascii, binary, raw, base64
    bool compressed = false, header64 = false, big_endian = false;
    std::string junk = "";  // bytes appended to each compressed block

    std::string name() const {
        return format + (compressed ? "_zlib" : "") + (header64 ? "_64" : "_32") +
               (big_endian ? "_big" : "_little");
    }
};

inline std::vector<VtuStyle> all_vtu_styles() {
    std::vector<VtuStyle> styles{{"ascii"}};
    for (const char* format : {"binary", "raw", "base64"}) {
        for (int bits = 0; bits < 8; ++bits) {
            styles.push_back({format, (bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0});
        }
    }
    return styles;
}

class VtuMaker {
  public:
    explicit VtuMaker(VtuStyle style) : style_(std::move(style)) {}

    std::string file(const std::vector<TestGrid>& pieces) {
        std::string body;
        for (const TestGrid& piece : pieces) body += piece_text(piece);
        std::string text = "<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"";
        text += style_.big_endian ? "BigEndian\"" : "LittleEndian\"";
        if (style_.header64) text += " header_type=\"UInt64\"";  // without it: UInt32
        if (style_.compressed) text += " compressor=\"vtkZLibDataCompressor\"";
        text += ">\n<UnstructuredGrid>\n" + body + "</UnstructuredGrid>\n";
        if (style_.format == "raw" || style_.format == "base64") {
            text += "<AppendedData encoding=\"" + style_.format + "\">\n  _" + appended_ +
                    "\n</AppendedData>\n";
        }
        return text + "</VTKFile>\n";
    }

  private:
    std::string piece_text(const TestGrid& grid) {
        std::string text = fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n",
                                       grid.points.size(), grid.cells.size());
        text += "<PointData>\n";
        for (const auto& array : grid.point_arrays) text += array_text(array);
        text += "</PointData>\n<CellData>\n";
        for (const auto& array : grid.cell_arrays) text += array_text(array);
        text += "</CellData>\n<Points>\n" + array_text(grid.points_array()) + "</Points>\n<Cells>";
        return text + array_text(grid.connectivity()) + array_text(grid.offsets()) +
               array_text(grid.types()) + "</Cells>\n</Piece>\n";
    }

    std::string array_text(const TestArray& array) {
        std::string name = array.name;
        for (std::size_t at = 0; (at = name.find_first_of("&<>", at)) != std::string::npos; ++at) {
            name.replace(at, 1, name[at] == '&' ? "&amp;" : name[at] == '<' ? "&lt;" : "&gt;");
        }
        std::string text = fmt::format("<DataArray type=\"{}\" Name=\"{}\"", array.type, name);
        if (array.components != 1) {
            text += fmt::format(" NumberOfComponents=\"{}\"", array.components);
        }
        if (style_.format == "ascii") {
            return text + " format=\"ascii\">\n" + text_of_array(array) + "\n</DataArray>\n";
        }
        if (style_.format == "binary") {
            return text + " format=\"binary\">\n" + coded(array, true) + "\n</DataArray>\n";
        }
        text += fmt::format(" format=\"appended\" offset=\"{}\"/>\n", appended_.size());
        appended_ += coded(array, style_.format == "base64");
        return text;
    }

    std::string header(const std::vector<double>& words) const {
        return bytes_of_array(style_.header64 ? "UInt64" : "UInt32", words, style_.big_endian);
    }

    std::string coded(const TestArray& array, bool text) const {
        const std::string bytes = bytes_of_array(array.type, array.values, style_.big_endian);
        if (!style_.compressed) {
            const std::string all = header({static_cast<double>(bytes.size())}) + bytes;
            return text ? base64(all) : all;
        }
        // Bytes; arrays then have several blocks, and the last one may be full or not.
        constexpr std::size_t block = 56;
        std::vector<double> words{std::ceil(static_cast<double>(bytes.size()) / block), block,
                                  static_cast<double>(bytes.size() % block)};
        std::string packed;
        for (std::size_t at = 0; at < bytes.size(); at += block) {
            const std::string one = zlib(bytes.substr(at, block)) + style_.junk;
            words.push_back(static_cast<double>(one.size()));
            packed += one;
        }
        return text ? base64(header(words)) + base64(packed) : header(words) + packed;
    }

    VtuStyle style_;
    std::string appended_;
};

inline std::string make_vtu(const TestGrid& grid, const VtuStyle& style = {}) {
    return VtuMaker(style).file({grid});
}

// Makes legacy VTK files of version 3.0 or 5.1.
class VtkMaker {
  public:
    VtkMaker(bool binary, bool version5) : binary_(binary), version5_(version5) {}

    std::string file(const TestGrid& grid) const {
        const auto n = grid.cells.size();
        std::string text = fmt::format("# vtk DataFile Version {}\na title\n{}\n",
                                       version5_ ? "5.1" : "3.0", binary_ ? "BINARY" : "ASCII");
        text += "DATASET UNSTRUCTURED_GRID\n";
        text += "FIELD FieldData 1\nTIME 1 1 double\n" + data({"", "Float64", 1, {2.5}});
        text += fmt::format("POINTS {} {}\n", grid.points.size(), legacy(grid.points_type)) +
                data(grid.points_array());
        text +=
            "METADATA\nINFORMATION 1\nNAME L2_NORM_RANGE LOCATION vtkDataArray\n"
            "DATA 2 0 1\n\n";
        text += cells(grid);
        TestArray types = grid.types();
        types.type = "Int32";
        text += fmt::format("CELL_TYPES {}\n", n) + data(types);
        text += fmt::format("POINT_DATA {}\n", grid.points.size());
        for (const auto& array : grid.point_arrays) {
            if (array.components == 1) {
                text += fmt::format("SCALARS {} {}{}\nLOOKUP_TABLE default\n", coded(array.name),
                                    legacy(array.type), array.type == "Int8" ? "" : " 1");
            } else if (array.components == 3) {
                text += fmt::format("VECTORS {} {}\n", coded(array.name), legacy(array.type));
            } else {
                text += fmt::format("TEXTURE_COORDINATES {} {} {}\n", coded(array.name),
                                    array.components, legacy(array.type));
            }
            text += data(array);
        }
        text += fmt::format("CELL_DATA {}\nFIELD FieldData {}\n", n, grid.cell_arrays.size());
        for (const auto& array : grid.cell_arrays) {
            text += fmt::format("{} {} {} {}\n", coded(array.name), array.components, n,
                                legacy(array.type)) +
                    data(array);
            text += "METADATA\nINFORMATION 0\n\n";
        }
        return text;
    }

    // Returns the name in legacy files of a type of VTK XML files.
    static std::string legacy(const std::string& type) {
        static const std::vector<std::pair<std::string, std::string>> names{
            {"Int8", "char"},          {"UInt8", "unsigned_char"},
            {"Int16", "short"},        {"UInt16", "unsigned_short"},
            {"Int32", "int"},          {"UInt32", "unsigned_int"},
            {"Int64", "vtktypeint64"}, {"UInt64", "vtktypeuint64"},
            {"Float32", "float"},      {"Float64", "double"}};
        for (const auto& [xml, name] : names) {
            if (xml == type) return name;
        }
        return "";
    }

  private:
    static std::string coded(const std::string& name) {
        std::string text;
        for (const char c : name) text += c == ' ' ? "%20" : std::string(1, c);
        return text;
    }

    std::string data(const TestArray& array) const {
        return (binary_ ? bytes_of_array(array.type, array.values, true) : text_of_array(array)) +
               "\n";
    }

    std::string cells(const TestGrid& grid) const {
        if (version5_) {
            TestArray offsets = grid.offsets(), indices = grid.connectivity();
            offsets.values.insert(offsets.values.begin(), 0);
            return fmt::format("CELLS {} {}\nOFFSETS {}\n", offsets.values.size(),
                               indices.values.size(), legacy(grid.index_type)) +
                   data(offsets) + "CONNECTIVITY " + legacy(grid.index_type) + "\n" + data(indices);
        }
        TestArray list{"", "Int32", 1, {}};
        for (const auto& cell : grid.cells) {
            list.values.push_back(static_cast<double>(cell.corners.size()));
            list.values.insert(list.values.end(), cell.corners.begin(), cell.corners.end());
        }
        return fmt::format("CELLS {} {}\n", grid.cells.size(), list.values.size()) + data(list);
    }

    bool binary_, version5_;
};

}  // namespace lamina::testing
