// SPDX-License-Identifier: Apache-2.0
#include "mesh_files/vtu_reader.h"

#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "mesh_files/vtu_file.h"

namespace lamina {
namespace {

pugi::xml_node child_of(pugi::xml_node node, const char* name, const std::string& label) {
    const pugi::xml_node child = node.child(name);
    if (!child) fail("{}: no <{}> in it", label, name);
    return child;
}

std::vector<std::int64_t> read_cell_array(const VtuFile& file, pugi::xml_node cells,
                                          const char* name, std::int64_t count,
                                          const std::string& label) {
    const pugi::xml_node array = cells.find_child_by_attribute("DataArray", "Name", name);
    if (!array) fail("{}: no array '{}' in <Cells>", label, name);
    const std::string what = label + ": " + name;
    if (const std::int64_t components = file.components_of(array, what); components != 1) {
        fail("{}: NumberOfComponents: found {}, expected 1", what, components);
    }
    return file.values<std::int64_t>(array, count, 1, what);
}

std::vector<MeshScalar> read_scalars(const VtuFile& file, pugi::xml_node piece, const char* section,
                                     std::int64_t tuples, const std::string& label) {
    std::vector<MeshScalar> scalars;
    int number = 0;
    for (const pugi::xml_node array : piece.child(section).children("DataArray")) {
        ++number;
        const std::string_view type = array.attribute("type").value();
        if (type == "String" || type == "Bit") continue;
        const auto given = array.attribute("Name");
        const std::string name = given ? given.value() : fmt::format("array {}", number);
        const std::string what = fmt::format("{}: {} '{}'", label, section, one_line(name));
        const std::int64_t components = file.components_of(array, what);
        if (!makes_scalar(components)) continue;
        add_scalars(scalars, name, components,
                    file.values<double>(array, tuples, components, what));
    }
    return scalars;
}

MeshPiece read_piece(const VtuFile& file, pugi::xml_node node, const std::string& label) {
    MeshPiece piece{label, {}, {}, {}, {}};
    const std::int64_t points = file.count_in(node, "NumberOfPoints", label);
    const std::int64_t cells = file.count_in(node, "NumberOfCells", label);
    if (points == 0 && cells == 0) return piece;

    const pugi::xml_node array =
        child_of(child_of(node, "Points", label), "DataArray", label + ": <Points>");
    const std::string what = label + ": Points";
    if (const std::int64_t components = file.components_of(array, what); components != 3) {
        fail("{}: NumberOfComponents: found {}, expected 3", what, components);
    }
    piece.points = points_from_values(file.values<double>(array, points, 3, what));

    const pugi::xml_node lists = child_of(node, "Cells", label);
    piece.cells.types = read_cell_array(file, lists, "types", cells, label);
    piece.cells.ends = read_cell_array(file, lists, "offsets", cells, label);
    const std::int64_t indices = cells == 0 ? 0 : piece.cells.ends.back();
    if (indices < 0) fail("{}: offsets: found {}, expected a number >= 0", label, indices);
    piece.cells.connectivity = read_cell_array(file, lists, "connectivity", indices, label);

    piece.point_scalars = read_scalars(file, node, "PointData", points, label);
    piece.cell_scalars = read_scalars(file, node, "CellData", cells, label);
    return piece;
}

}  // namespace

void add_vtu(const std::filesystem::path& path, MeshAssembly& assembly) {
    const VtuFile file(path);
    const auto pieces = file.grid().children("Piece");
    const bool single = std::distance(pieces.begin(), pieces.end()) == 1;
    int number = 0;
    for (const pugi::xml_node piece : pieces) {
        ++number;
        assembly.add(read_piece(
            file, piece, single ? file.name() : fmt::format("{}: Piece {}", file.name(), number)));
    }
    if (number == 0) fail("{}: no <Piece> in it", file.name());
}

MeshData read_vtu(const std::filesystem::path& path) {
    MeshAssembly assembly(path.string());
    add_vtu(path, assembly);
    return assembly.finish();
}

}  // namespace lamina
