// SPDX-License-Identifier: Apache-2.0
// TetGen's manual, section 5.2, describes the formats.
#include "mesh_files/mesh_formats.h"

#include <fmt/format.h>

#include <array>
#include <iterator>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

#include "base/client.h"
#include "base/error.h"
#include "base/input_file.h"
#include "mesh_files/mesh_assembly.h"
#include "mesh_files/mesh_file.h"
#include "mesh_files/text_reader.h"

namespace lamina {
namespace {

// Reads the lines of a TetGen file that have numbers on them.
class Lines {
  public:
    Lines(std::string file, std::string_view text)
        : file_(std::move(file)), text_(text), reader_(text) {}

    // Moves to the next line that has more than a comment. Returns false at the end.
    bool next() {
        while (reader_.left() > 0) {
            const std::string_view whole = reader_.line();
            ++number_;
            line_ = TextReader(whole.substr(0, whole.find('#')));
            if (!line_.at_end()) return true;
        }
        return false;
    }

    std::string where() const { return fmt::format("{}: line {}", file_, number_); }
    const std::string& file() const { return file_; }
    std::size_t bytes_left() const { return reader_.left(); }
    TextReader& line() { return line_; }

    template <typename T>
    T number(const char* what) {
        T value{};
        if (!line_.read(value)) {
            fail("{}: {}: found {}, expected a {}", where(), what,
                 line_.at_end() ? "the end of the line" : next_word(line_),
                 std::is_integral_v<T> ? "whole number" : "number");
        }
        return value;
    }

    // Reads a number >= 0; returns `otherwise` if the line has no more words.
    std::int64_t count(const char* what, std::int64_t otherwise) {
        if (line_.at_end()) return otherwise;
        const auto value = number<std::int64_t>(what);
        if (value < 0) fail("{}: {}: found {}, expected a number >= 0", where(), what, value);
        return value;
    }

    void expect_line_end(const char* what) {
        if (line_.at_end()) return;
        fail("{}: found {} after the {}", where(), next_word(line_), what);
    }

    // Throws Error unless the file is long enough for `numbers` numbers on each of `rows` lines.
    void check_promise(const char* what, std::int64_t rows, std::int64_t numbers) const {
        const std::size_t most = bytes_left() / static_cast<std::size_t>(numbers);
        if (static_cast<std::uint64_t>(rows) <= most) return;
        fail("{}: promises {} {} of {} numbers each, the file has {} bytes left", where(), rows,
             what, numbers, bytes_left());
    }

    // Makes empty scalars with the names that the comments before the first numbers give them.
    std::vector<MeshScalar> attributes(const std::string& owner, std::int64_t count,
                                       std::int64_t rows) const {
        std::vector<MeshScalar> scalars(static_cast<std::size_t>(count));
        for (std::size_t i = 0; i < scalars.size(); ++i) {
            scalars[i].name = fmt::format("{} attribute {}", owner, i + 1);
            scalars[i].values.reserve(static_cast<std::size_t>(rows));
        }
        const std::string start = "# " + owner + " attribute ";
        TextReader lines(text_);
        for (std::string_view line = lines.line(); line.starts_with('#'); line = lines.line()) {
            if (!line.starts_with(start)) continue;
            const std::size_t colon = line.find(": ", start.size());
            std::int64_t number = 0;
            TextReader digits(line.substr(0, colon).substr(start.size()));
            if (!digits.read(number) || number < 1 || number > count) continue;
            std::string_view name = colon == line.npos ? "" : line.substr(colon + 2);
            while (!name.empty() && TextReader::is_blank(name.back())) name.remove_suffix(1);
            if (name.empty()) continue;
            scalars[static_cast<std::size_t>(number) - 1].name = one_line(std::string(name));
        }
        return scalars;
    }

  private:
    std::string file_;
    std::string_view text_;
    TextReader reader_;
    TextReader line_{""};
    std::size_t number_ = 0;
};

constexpr std::int64_t most_attributes = 1000;

// Reads the points of a .node file and their scalars. Returns the first point's number, 0 or 1.
std::int64_t read_nodes(Lines& lines, MeshPiece& mesh) {
    if (!lines.next()) fail("{}: found no numbers", lines.file());
    const std::int64_t points = lines.count("number of points", 0);
    const std::int64_t dimension = lines.count("dimension", 3);
    const std::int64_t attributes = lines.count("number of attributes", 0);
    const std::int64_t markers = lines.count("boundary markers", 0);
    lines.expect_line_end("four numbers of the first line");
    if (dimension != 3) fail("{}: dimension: found {}, expected 3", lines.where(), dimension);
    if (markers > 1) {
        fail("{}: boundary markers: found {}, expected 0 or 1", lines.where(), markers);
    }
    if (points == 0) fail("{}: found no points", lines.file());
    if (points > std::numeric_limits<std::int32_t>::max() || attributes > most_attributes) {
        fail("{}: found {} points with {} attributes, expected at most {} with {}", lines.where(),
             points, attributes, std::numeric_limits<std::int32_t>::max(), most_attributes);
    }
    lines.check_promise("points", points, 4 + attributes + markers);

    mesh.points.resize(static_cast<std::size_t>(points));
    mesh.point_scalars = lines.attributes("point", attributes, points);
    std::int64_t first = 0;
    for (std::int64_t i = 0; i < points; ++i) {
        if ((i & 0xffff) == 0) check_interrupt();
        if (!lines.next()) {
            fail("{}: found {} points, expected {}", lines.file(), i, points);
        }
        const auto index = lines.number<std::int64_t>("number of the point");
        if (i == 0) first = index;
        if (first != 0 && first != 1) {
            fail("{}: number of the first point: found {}, expected 0 or 1", lines.where(), first);
        }
        if (index != first + i) {
            fail("{}: number of the point: found {}, expected {}", lines.where(), index, first + i);
        }
        glm::dvec3& point = mesh.points[static_cast<std::size_t>(i)];
        for (int axis = 0; axis < 3; ++axis) point[axis] = lines.number<double>("coordinate");
        for (MeshScalar& scalar : mesh.point_scalars) {
            scalar.values.push_back(lines.number<double>("attribute"));
        }
        if (markers == 1) lines.number<std::int64_t>("boundary marker");
        lines.expect_line_end("point");
    }
    return first;
}

// The places of a VTK quadratic tet's points in TetGen's list: corners, then middles of the edges
// 0-1, 1-2, 2-0, 0-3, 1-3, 2-3, of which TetGen ("-o2") lists 2-3, 3-0, 0-1, 1-2, 1-3, 2-0.
constexpr std::array<std::size_t, 10> vtk_order{0, 1, 2, 3, 6, 7, 9, 5, 8, 4};

void read_tets(Lines& lines, std::int64_t first_point, MeshPiece& mesh) {
    if (!lines.next()) fail("{}: found no numbers", lines.file());
    const std::int64_t tets = lines.count("number of tetrahedra", 0);
    const std::int64_t nodes = lines.count("nodes of a tetrahedron", 4);
    const std::int64_t attributes = lines.count("number of attributes", 0);
    lines.expect_line_end("three numbers of the first line");
    if (nodes != 4 && nodes != 10) {
        fail("{}: nodes of a tetrahedron: found {}, expected 4 or 10", lines.where(), nodes);
    }
    if (tets == 0) fail("{}: found no tetrahedra", lines.file());
    if (attributes > most_attributes) {
        fail("{}: found {} attributes, expected at most {}", lines.where(), attributes,
             most_attributes);
    }
    lines.check_promise("tetrahedra", tets, 1 + nodes + attributes);

    constexpr std::int64_t quadratic_tetra = 24;
    const auto each = static_cast<std::size_t>(nodes);
    mesh.cells.types.assign(static_cast<std::size_t>(tets),
                            nodes == 10 ? quadratic_tetra : vtk_tetra);
    mesh.cells.connectivity.reserve(static_cast<std::size_t>(tets) * each);
    mesh.cell_scalars = lines.attributes("tet", attributes, tets);
    const std::int64_t last_point = first_point + static_cast<std::int64_t>(mesh.points.size()) - 1;
    for (std::int64_t i = 0; i < tets; ++i) {
        if ((i & 0xffff) == 0) check_interrupt();
        if (!lines.next()) {
            fail("{}: found {} tetrahedra, expected {}", lines.file(), i, tets);
        }
        lines.number<std::int64_t>("number of the tetrahedron");
        std::array<std::int64_t, 10> points{};
        for (std::size_t point = 0; point < each; ++point) {
            const auto index = lines.number<std::int64_t>("point of the tetrahedron");
            if (index < first_point || index > last_point) {
                fail("{}: point of the tetrahedron: found {}, expected {} to {}", lines.where(),
                     index, first_point, last_point);
            }
            points[point] = index - first_point;
        }
        for (std::size_t point = 0; point < each; ++point)
            mesh.cells.connectivity.push_back(points[vtk_order[point]]);
        mesh.cells.ends.push_back(std::ssize(mesh.cells.connectivity));
        for (MeshScalar& scalar : mesh.cell_scalars) {
            scalar.values.push_back(lines.number<double>("attribute"));
        }
        lines.expect_line_end("tetrahedron");
    }
}

void expect_file_end(Lines& lines, std::int64_t rows, const char* what) {
    if (lines.next()) {
        fail("{}: found {} after the {} {} promised", lines.where(), next_word(lines.line()), rows,
             what);
    }
}

constexpr std::size_t buffer_bytes = std::size_t{1} << 20;

// Writes the names in the comments that read_node_ele() looks for.
void write_names(AtomicFile& file, const char* owner, const std::vector<MeshScalar>& scalars) {
    for (std::size_t i = 0; i < scalars.size(); ++i) {
        file.write(fmt::format("# {} attribute {}: {}\n", owner, i + 1, one_line(scalars[i].name)));
    }
}

// Writes lines of text, each made by `append(line number, text)`.
template <typename Append>
void write_lines(AtomicFile& file, std::size_t count, const Append& append) {
    std::string text;
    for (std::size_t i = 0; i < count; ++i) {
        append(i, text);
        text += '\n';
        if (text.size() < buffer_bytes && i + 1 < count) continue;
        check_interrupt();
        file.write(text);
        text.clear();
    }
}

void append_values(std::string& text, const std::vector<MeshScalar>& scalars, std::size_t row) {
    for (const MeshScalar& scalar : scalars) {
        fmt::format_to(std::back_inserter(text), " {:.17g}", scalar.values[row]);
    }
}

}  // namespace

MeshData read_node_ele(const std::filesystem::path& path, double join) {
    std::filesystem::path node = path, ele = path;
    if (path.extension() == ".ele") {
        node.replace_extension(".node");
    } else {
        ele.replace_extension(".ele");
    }
    for (const auto& file : {node, ele}) {
        expect_allowed(file);
        if (std::filesystem::exists(file)) continue;
        fail("{}: no such file{}", file.string(),
             file == path ? "" : fmt::format("; expected beside {}", path.string()));
    }
    MeshPiece mesh;
    mesh.label = ele.string();
    const ByteBuffer node_text = read_large_file(node);
    Lines node_lines(node.string(), node_text.text());
    const std::int64_t first_point = read_nodes(node_lines, mesh);
    expect_file_end(node_lines, static_cast<std::int64_t>(mesh.points.size()), "points");

    const ByteBuffer ele_text = read_large_file(ele);
    Lines ele_lines(ele.string(), ele_text.text());
    read_tets(ele_lines, first_point, mesh);
    expect_file_end(ele_lines, std::ssize(mesh.cells.types), "tetrahedra");
    MeshAssembly assembly(ele.string(), join);
    assembly.add(std::move(mesh));
    return assembly.finish();
}

void write_node(AtomicFile& file, const MeshData& mesh) {
    write_names(file, "point", mesh.point_scalars);
    file.write(fmt::format("{} 3 {} 0\n", mesh.points.size(), mesh.point_scalars.size()));
    write_lines(file, mesh.points.size(), [&](std::size_t i, std::string& text) {
        const glm::dvec3& point = mesh.points[i];
        fmt::format_to(std::back_inserter(text), "{} {:.17g} {:.17g} {:.17g}", i + 1, point.x,
                       point.y, point.z);
        append_values(text, mesh.point_scalars, i);
    });
}

void write_ele(AtomicFile& file, const MeshData& mesh) {
    write_names(file, "tet", mesh.cell_scalars);
    file.write(fmt::format("{} 4 {}\n", mesh.tets.size(), mesh.cell_scalars.size()));
    write_lines(file, mesh.tets.size(), [&](std::size_t i, std::string& text) {
        const Tet& tet = mesh.tets[i];
        fmt::format_to(std::back_inserter(text), "{} {} {} {} {}", i + 1, tet[0] + std::int64_t{1},
                       tet[1] + std::int64_t{1}, tet[2] + std::int64_t{1},
                       tet[3] + std::int64_t{1});
        append_values(text, mesh.cell_scalars, i);
    });
}

}  // namespace lamina
