// SPDX-License-Identifier: Apache-2.0
// "VTK File Formats" (the VTK User's Guide) and, for what it does not say, vtkDataReader.cxx.
#include "mesh_files/mesh_formats.h"

#include <string>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "base/input_file.h"
#include "base/value_type.h"
#include "mesh_files/mesh_assembly.h"
#include "mesh_files/vtk_tokens.h"

namespace lamina {
namespace {

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
        const VtkHeader header = read_vtk_header(tokens_);
        if (header.dataset != "unstructured_grid") {
            fail("{}: found 'DATASET {}', expected 'DATASET UNSTRUCTURED_GRID'", tokens_.where(),
                 header.dataset);
        }
        offsets_and_connectivity_ = header.version >= 5;
        piece_.old_hexahedra = header.version < 5.1;  // vtkUnstructuredGridReader
        tokens_.set_binary(header.binary);
    }

    void read_section(const std::string& word) {
        const auto take = [&](const VtkArrayLine& array) { read_array(array); };
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
            read_vtk_field(tokens_, take);
        } else if (word == "metadata") {
            tokens_.skip_metadata();
        } else if (data_ == Data::none || !read_vtk_attribute(tokens_, word, tuples_, take)) {
            fail("{}: found '{}', expected a keyword (POINTS, CELLS, SCALARS, ...)",
                 tokens_.where(), printable(word));
        }
    }

    void once(bool& seen, const char* section) {
        if (seen) fail("{}: a second {}, expected one", tokens_.where(), section);
        seen = true;
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
        const std::int64_t count = tokens_.product(tokens_.count("POINTS"), 3, "POINTS");
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

    void read_array(const VtkArrayLine& array) {
        const std::string what = "'" + array.name + "'";
        const std::int64_t count = tokens_.product(array.components, array.tuples, what);
        if (data_ == Data::none || array.colours || !makes_scalar(array.components) ||
            array.type.kind != VtkType::Kind::number) {
            tokens_.skip_values(array.type, count, what);
            return;
        }
        if (array.tuples != tuples_) {
            fail("{}: {}: found {} values, expected {}", tokens_.where(), what, array.tuples,
                 tuples_);
        }
        auto& scalars = data_ == Data::point ? piece_.point_scalars : piece_.cell_scalars;
        add_scalars(scalars, array.name, array.components,
                    tokens_.values<double>(array.type.value, count, what));
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

MeshData read_vtk(const std::filesystem::path& path, double join) {
    const ByteBuffer bytes = read_large_file(path);
    MeshAssembly assembly(path.string(), join);
    assembly.add(VtkReader(path.string(), bytes.text()).read());
    return assembly.finish();
}

}  // namespace lamina
