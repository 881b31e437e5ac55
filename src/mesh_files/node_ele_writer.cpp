// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <iterator>
#include <string>
#include <vector>

#include "base/client.h"
#include "base/error.h"
#include "mesh_files/mesh_file.h"

namespace lamina {
namespace {

constexpr std::size_t buffer_bytes = std::size_t{1} << 20;

// Writes the names in comments, where read_node_ele() looks for them.
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
