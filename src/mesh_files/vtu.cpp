// SPDX-License-Identifier: Apache-2.0
// .pvtu: "VTK File Formats", "Parallel unstructured grid", and vtkXMLPUnstructuredGridWriter.
// .pvd: "ParaView/Data formats", "PVD File Format": <DataSet timestep="T" part="N" file="F"/>.
#include "mesh_files/mesh_formats.h"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>
#include <map>
#include <pugixml.hpp>
#include <set>
#include <span>
#include <string_view>

#include "base/error.h"
#include "base/input_file.h"
#include "base/parallel.h"
#include "mesh_files/mesh_assembly.h"
#include "mesh_files/mesh_file.h"
#include "mesh_files/text_reader.h"
#include "mesh_files/vtk_xml.h"

namespace lamina {
namespace {

// A VTK XML file without numbers of its own, which names other files: .pvtu, .pvd.
class VtkIndex {
  public:
    // `type`: the type of its VTKFile element and the name of that element's child. Throws Error.
    VtkIndex(const std::filesystem::path& path, const char* type) : name_(path.string()) {
        expect_allowed(path);
        constexpr std::size_t most_bytes = std::size_t{64} << 20, most_tags = 1'000'000;
        const std::uintmax_t size =
            std::filesystem::is_regular_file(path) ? std::filesystem::file_size(path) : 0;
        if (size > most_bytes) {
            fail("{}: found {} bytes, expected at most {}, because it only names files", name_,
                 size, most_bytes);
        }
        const std::string text = read_file_bytes(path);
        const auto marks = static_cast<std::size_t>(
            std::ranges::count_if(text, [](char c) { return c == '<' || c == '='; }));
        if (marks > most_tags)
            fail("{}: found {} tags and attributes, expected at most {}", name_, marks, most_tags);
        const pugi::xml_parse_result result = document_.load_buffer(
            text.data(), text.size(), pugi::parse_escapes, pugi::encoding_utf8);
        if (!result) {
            fail("{}: truncated or damaged XML at byte {} of {}: {}", name_, result.offset,
                 text.size(), result.description());
        }
        const pugi::xml_node root = document_.child("VTKFile");
        if (!root) fail("{}: not a VTK XML file: no <VTKFile> in it", name_);
        const std::string found = root.attribute("type").value();
        if (found != type)
            fail("{}: VTKFile type: found '{}', expected '{}'", name_, one_line(found), type);
        node_ = root.child(type);
        if (!node_) fail("{}: no <{}> in it", name_, type);
    }

    const std::string& name() const { return name_; }
    pugi::xml_node node() const { return node_; }
    // Returns the file that an attribute names, relative to this one. `what`: for messages.
    std::filesystem::path file_in(pugi::xml_node node, const char* attribute,
                                  const std::string& what) const {
        const std::filesystem::path file = node.attribute(attribute).value();
        if (file.empty()) fail("{}: {}: {}: found none, expected a file", name_, what, attribute);
        return std::filesystem::path(name_).parent_path() / file;  // an absolute one stays as it is
    }

  private:
    std::string name_;
    pugi::xml_document document_;
    pugi::xml_node node_;
};

// Throws Error if a list names a file twice. `name`: the file with the list.
void expect_each_once(const std::vector<std::filesystem::path>& files, const std::string& name) {
    std::set<std::filesystem::path> seen;
    for (const std::filesystem::path& file : files) {
        std::error_code unreadable;  // such a file fails when it is read
        const auto canonical = std::filesystem::weakly_canonical(file, unreadable);
        if (!seen.insert(unreadable ? file : canonical).second)
            fail("{}: found the file {} twice, expected each once", name, one_line(file.string()));
    }
}

pugi::xml_node child_of(pugi::xml_node node, const char* name, const std::string& label) {
    const pugi::xml_node child = node.child(name);
    if (!child) fail("{}: no <{}> in it", label, name);
    return child;
}

std::vector<std::int64_t> read_cell_array(const VtkXmlFile& file, pugi::xml_node cells,
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

// The attribute of <CellData> that names the array of the orders of Lagrange cells
// (vtkDataSetAttributes).
constexpr const char* orders_attribute = "HigherOrderDegrees";

// Returns the last offset, which is the length of the list that they divide.
std::int64_t length_of(const std::vector<std::int64_t>& ends, const std::string& what) {
    const std::int64_t length = ends.empty() ? 0 : ends.back();
    if (length < 0) fail("{}: found {}, expected a number >= 0", what, length);
    return length;
}

// Returns the part of a list that ends[number] ends.
std::span<const std::int64_t> part_of(const std::vector<std::int64_t>& list,
                                      const std::vector<std::int64_t>& ends, std::int64_t number,
                                      const std::string& what) {
    if (number < 0 || number >= std::ssize(ends))
        fail("{}: found number {}, expected 0 to {}", what, number, std::ssize(ends) - 1);
    const auto at = static_cast<std::size_t>(number);
    const std::int64_t begin = at == 0 ? 0 : ends[at - 1], end = ends[at];
    if (begin < 0 || end < begin || end > std::ssize(list))
        fail("{}: found {} after {}, expected up to {}", what, end, begin, list.size());
    return std::span(list).subspan(static_cast<std::size_t>(begin),
                                   static_cast<std::size_t>(end - begin));
}

// Reads the faces of polyhedra: as a stream, or (from VTK 9.4 on, version 2.3) as a list of faces
// and one of each cell's faces, which are made a stream.
void read_faces_of(const VtkXmlFile& file, pugi::xml_node lists, const std::string& label,
                   MeshCells& cells) {
    const auto count = std::ssize(cells.types);
    const auto read = [&](const char* name, std::int64_t length) {
        return read_cell_array(file, lists, name, length, label);
    };
    if (!lists.find_child_by_attribute("DataArray", "Name", "polyhedron_to_faces")) {
        cells.face_ends = read("faceoffsets", count);
        const auto longest = std::ranges::max_element(cells.face_ends);
        cells.faces = read("faces", std::max(*longest, std::int64_t{0}));
        return;
    }
    const auto cell_ends = read("polyhedron_offsets", count);
    const auto face_numbers =
        read("polyhedron_to_faces", length_of(cell_ends, label + ": polyhedron_offsets"));
    constexpr std::int64_t most_faces = std::numeric_limits<std::int32_t>::max();
    std::int64_t last = -1;
    for (const std::int64_t number : face_numbers) {
        if (number < 0 || number > most_faces)
            fail("{}: polyhedron_to_faces: found {}, expected 0 to {}", label, number, most_faces);
        last = std::max(last, number);
    }
    const auto ends = read("face_offsets", last + 1);
    const auto corners = read("face_connectivity", length_of(ends, label + ": face_offsets"));
    std::vector<int> uses(ends.size(), 0);  // more than two would let a small file fill all memory
    for (std::int64_t cell = 0; cell < count; ++cell) {
        const auto numbers = part_of(face_numbers, cell_ends, cell, label + ": polyhedron_offsets");
        if (!numbers.empty()) cells.faces.push_back(std::ssize(numbers));
        for (const std::int64_t number : numbers) {
            const auto face = part_of(corners, ends, number, label + ": face_offsets");
            if (++uses[static_cast<std::size_t>(number)] > 2)
                fail("{}: polyhedron_to_faces: found face {} thrice, expected at most twice", label,
                     number);
            cells.faces.push_back(std::ssize(face));
            cells.faces.insert(cells.faces.end(), face.begin(), face.end());
        }
        cells.face_ends.push_back(numbers.empty() ? -1 : std::ssize(cells.faces));
    }
}

// Tells if a file's version is below 2.1, from which on VTK numbers the points of Lagrange
// hexahedra anew (vtkXMLUnstructuredGridReader, vtkUpdateCellsV8toV9).
bool numbers_as_vtk_8(const VtkXmlFile& file) {
    TextReader reader(file.grid().parent().attribute("version").as_string("0.1"));
    double version = 0;
    return !reader.read(version) || version < 2.1;
}

// Reads the orders of Lagrange cells along their axes, if the file has them.
std::vector<double> read_orders(const VtkXmlFile& file, pugi::xml_node data, std::int64_t cells,
                                const std::string& label) {
    const char* const name = data.attribute(orders_attribute).value();
    const pugi::xml_node array = data.find_child_by_attribute("DataArray", "Name", name);
    if (!array || file.components_of(array, label) != 3) return {};
    return file.values<double>(array, cells, 3, label + ": " + orders_attribute);
}

std::vector<MeshScalar> read_scalars(const VtkXmlFile& file, pugi::xml_node piece,
                                     const char* section, std::int64_t tuples,
                                     const std::string& label) {
    std::vector<MeshScalar> scalars;
    int number = 0;
    for (const pugi::xml_node array : piece.child(section).children("DataArray")) {
        ++number;
        const std::string_view type = array.attribute("type").value();
        const char* const orders = piece.child(section).attribute(orders_attribute).value();
        if (type == "String" || type == "Bit") continue;
        if (*orders != '\0' && orders == std::string_view(array.attribute("Name").value()))
            continue;
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

MeshPiece read_piece(const VtkXmlFile& file, pugi::xml_node node, const std::string& label) {
    MeshPiece piece;
    piece.label = label;
    piece.old_hexahedra = numbers_as_vtk_8(file);
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
    const std::int64_t indices = length_of(piece.cells.ends, label + ": offsets");
    piece.cells.connectivity = read_cell_array(file, lists, "connectivity", indices, label);

    if (std::ranges::count(piece.cells.types, vtk_polyhedron) > 0)
        read_faces_of(file, lists, label, piece.cells);

    piece.point_scalars = read_scalars(file, node, "PointData", points, label);
    piece.orders = read_orders(file, node.child("CellData"), cells, label);
    piece.cell_scalars = read_scalars(file, node, "CellData", cells, label);
    return piece;
}

void add_vtu(const std::filesystem::path& path, MeshAssembly& assembly) {
    expect_no_foreign_mesh(path);
    const VtkXmlFile file(path);
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

void add_pvtu(const std::filesystem::path& path, MeshAssembly& assembly) {
    for (const std::filesystem::path& piece : pieces_of_pvtu(path)) add_vtu(piece, assembly);
}

double time_of(pugi::xml_node set, const std::string& what) {
    const pugi::xml_attribute attribute = set.attribute("timestep");
    if (!attribute) return 0;
    TextReader reader(attribute.value());
    double time = 0;
    if (!reader.read(time) || !reader.at_end() || !std::isfinite(time)) {
        fail("{}: timestep: found {}, expected a number", what,
             next_word(TextReader(attribute.value())));
    }
    return time;
}

constexpr std::size_t block_bytes = std::size_t{1} << 20;
constexpr std::int64_t tetra_type = 10;

// Returns an array in the form of the appended data: header, then blocks.
std::string compress(const void* values, std::size_t size) {
    const std::size_t count = (size + block_bytes - 1) / block_bytes;
    std::vector<std::string> blocks(count);
    parallel_for(static_cast<std::int64_t>(count), 1, [&](std::int64_t i) {
        const std::size_t begin = static_cast<std::size_t>(i) * block_bytes;
        const std::size_t length = std::min(block_bytes, size - begin);
        std::string& block = blocks[static_cast<std::size_t>(i)];
        uLongf packed = compressBound(length);
        block.resize(packed);
        const int result =
            compress2(reinterpret_cast<Bytef*>(block.data()), &packed,
                      static_cast<const Bytef*>(values) + begin, length, Z_DEFAULT_COMPRESSION);
        if (result != Z_OK) throw std::bad_alloc();  // compressBound leaves no other reason
        block.resize(packed);
    });
    std::vector<std::uint64_t> header{count, block_bytes, size % block_bytes};
    for (const std::string& block : blocks) header.push_back(block.size());
    std::string packed(reinterpret_cast<const char*>(header.data()),
                       header.size() * sizeof(std::uint64_t));
    for (const std::string& block : blocks) packed += block;
    return packed;
}

std::string escaped(const std::string& name) {
    std::string text;
    for (const char c : one_line(name)) {
        constexpr std::pair<char, const char*> marks[] = {
            {'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}};
        const auto* const mark = std::ranges::find(marks, c, &std::pair<char, const char*>::first);
        text += mark == std::end(marks) ? std::string(1, c) : mark->second;
    }
    return text;
}

// Collects the elements of the XML and the appended data behind it.
class Writer {
  public:
    void open(const std::string& element) { xml_ += "      <" + element + ">\n"; }
    void close(const std::string& element) { xml_ += "      </" + element + ">\n"; }

    template <typename T>
    void array(const char* type, const std::string& name, int components,
               const std::vector<T>& values) {
        xml_ += fmt::format(
            "        <DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" "
            "format=\"appended\" offset=\"{}\"/>\n",
            type, escaped(name), components, data_.size());
        static_assert(sizeof(T) % 4 == 0 || sizeof(T) == 1);
        data_ += compress(values.data(), values.size() * sizeof(T));
    }

    void scalars(const std::string& element, const std::vector<MeshScalar>& all) {
        xml_ += all.empty() ? "      <" + element + ">\n"
                            : "      <" + element + " Scalars=\"" + escaped(all[0].name) + "\">\n";
        for (const MeshScalar& scalar : all) array("Float64", scalar.name, 1, scalar.values);
        close(element);
    }

    const std::string& xml() const { return xml_; }
    const std::string& data() const { return data_; }

  private:
    std::string xml_, data_;
};

template <typename T>
std::vector<T> offsets(std::size_t tets) {
    std::vector<T> ends(tets);
    for (std::size_t i = 0; i < tets; ++i) ends[i] = static_cast<T>(4 * (i + 1));
    return ends;
}

}  // namespace

MeshData read_vtu(const std::filesystem::path& path, double join) {
    MeshAssembly assembly(path.string(), join);
    add_vtu(path, assembly);
    return assembly.finish();
}

std::vector<std::filesystem::path> pieces_of_pvtu(const std::filesystem::path& path) {
    const VtkIndex index(path, "PUnstructuredGrid");
    std::vector<std::filesystem::path> files;
    for (const pugi::xml_node piece : index.node().children("Piece")) {
        files.push_back(index.file_in(piece, "Source", fmt::format("Piece {}", files.size() + 1)));
    }
    if (files.empty()) fail("{}: no <Piece> in it", index.name());
    expect_each_once(files, index.name());
    return files;
}

MeshData read_pvtu(const std::filesystem::path& path, double join) {
    MeshAssembly assembly(path.string(), join);
    add_pvtu(path, assembly);
    return assembly.finish();
}

std::vector<PvdStep> steps_of_pvd(const std::filesystem::path& path) {
    const VtkIndex index(path, "Collection");
    std::map<double, std::vector<std::filesystem::path>> by_time;
    std::size_t number = 0;
    for (const pugi::xml_node set : index.node().children("DataSet")) {
        const std::string which = fmt::format("DataSet {}", ++number);
        by_time[time_of(set, index.name() + ": " + which)].push_back(
            index.file_in(set, "file", which));
    }
    if (by_time.empty()) fail("{}: no <DataSet> in it", index.name());
    std::vector<PvdStep> steps;
    for (auto& [time, files] : by_time) {
        expect_each_once(files, fmt::format("{}: timestep {}", index.name(), time));
        steps.push_back({time, std::move(files)});
    }
    return steps;
}

MeshData read_pvd(const std::filesystem::path& path, std::int64_t step, double join) {
    const std::vector<PvdStep> steps = steps_of_pvd(path);
    if (step < 0 || step >= std::ssize(steps)) {
        fail("{}: time: found {}, expected 0 to {}, the steps of the file", path.string(), step,
             std::ssize(steps) - 1);
    }
    const PvdStep& chosen = steps[static_cast<std::size_t>(step)];
    MeshAssembly assembly(fmt::format("{}: step {} (time {})", path.string(), step, chosen.time),
                          join);
    for (const std::filesystem::path& file : chosen.files) {
        if (file.extension() == ".pvtu") {
            add_pvtu(file, assembly);
        } else {
            add_vtu(file, assembly);
        }
    }
    return assembly.finish();
}

void write_vtu(AtomicFile& file, const MeshData& mesh) {
    static_assert(sizeof(glm::dvec3) == 3 * sizeof(double) && sizeof(Tet) == 16);
    Writer writer;
    writer.scalars("PointData", mesh.point_scalars);
    writer.scalars("CellData", mesh.cell_scalars);
    writer.open("Points");
    writer.array("Float64", "Points", 3, mesh.points);
    writer.close("Points");
    writer.open("Cells");
    writer.array("Int32", "connectivity", 1, mesh.tets);
    if (4 * mesh.tets.size() <= std::numeric_limits<std::int32_t>::max()) {
        writer.array("Int32", "offsets", 1, offsets<std::int32_t>(mesh.tets.size()));
    } else {
        writer.array("Int64", "offsets", 1, offsets<std::int64_t>(mesh.tets.size()));
    }
    writer.array("UInt8", "types", 1, std::vector<std::uint8_t>(mesh.tets.size(), tetra_type));
    writer.close("Cells");

    file.write(fmt::format(
        "<?xml version=\"1.0\"?>\n"
        "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"{}\" "
        "header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\n"
        "  <UnstructuredGrid>\n    <Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n",
        std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian",
        mesh.points.size(), mesh.tets.size()));
    file.write(writer.xml());
    file.write("    </Piece>\n  </UnstructuredGrid>\n  <AppendedData encoding=\"raw\">\n   _");
    file.write(writer.data());
    file.write("\n  </AppendedData>\n</VTKFile>\n");
}

}  // namespace lamina
