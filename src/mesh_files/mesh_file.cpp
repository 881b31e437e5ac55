// SPDX-License-Identifier: Apache-2.0
#include "mesh_files/mesh_file.h"

#include <string>

#include "base/error.h"
#include "mesh_files/node_ele.h"
#include "mesh_files/vtk_reader.h"
#include "mesh_files/vtu_reader.h"

namespace lamina {

bool is_mesh_file(const std::filesystem::path& path) {
    const auto extension = path.extension();
    return extension == ".vtu" || extension == ".vtk" || extension == ".node" ||
           extension == ".ele";
}

MeshData read_mesh(const std::filesystem::path& path) {
    const auto extension = path.extension();
    if (extension == ".vtu") return read_vtu(path);
    if (extension == ".vtk") return read_vtk(path);
    if (extension == ".node" || extension == ".ele") return read_node_ele(path);
    fail("{}: not a mesh file: found extension '{}', expected .vtu, .vtk, .node or .ele",
         path.string(), extension.string());
}

}  // namespace lamina
