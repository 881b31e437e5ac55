// SPDX-License-Identifier: Apache-2.0
#include "mesh_files/mesh_file.h"

#include <algorithm>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/file_bytes.h"
#include "mesh_files/node_ele.h"
#include "mesh_files/vtk_reader.h"
#include "mesh_files/vtu_reader.h"

namespace lamina {

namespace {

using Path = std::filesystem::path;

// Text that VTK's files begin with.
constexpr const char* vtk_magic = "# vtk DataFile";

struct MeshFormat {
    MeshData (*read)(const Path&);
    bool (*holds)(const std::string& beginning);
    std::vector<std::string> extensions;
};

bool is_vtk(const std::string& beginning) {
    return beginning.starts_with(vtk_magic);
}

bool is_vtu(const std::string& beginning) {
    const std::size_t tag = beginning.find("<VTKFile");
    return tag != std::string::npos && beginning.find("UnstructuredGrid", tag) != std::string::npos;
}

// TetGen's files are numbers, which could mean anything.
bool is_node_ele(const std::string& /*beginning*/) {
    return false;
}

const MeshFormat* find_format(const Path& path) {
    static const std::vector<MeshFormat> formats{{read_vtu, is_vtu, {".vtu"}},
                                                 {read_vtk, is_vtk, {".vtk"}},
                                                 {read_node_ele, is_node_ele, {".node", ".ele"}}};
    const std::string beginning = file_beginning(path, 512);
    for (const MeshFormat& format : formats) {
        if (format.holds(beginning)) return &format;
    }
    for (const MeshFormat& format : formats) {
        if (std::ranges::count(format.extensions, path.extension().string()) > 0) return &format;
    }
    return nullptr;
}

}  // namespace

bool is_mesh_file(const Path& path) {
    return find_format(path) != nullptr;
}

MeshData read_mesh(const Path& path) {
    if (const MeshFormat* const format = find_format(path)) return format->read(path);
    fail("{}: not a mesh file: found extension '{}', expected .vtu, .vtk, .node or .ele",
         path.string(), path.extension().string());
}

}  // namespace lamina
