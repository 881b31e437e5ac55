// SPDX-License-Identifier: Apache-2.0
// "VTK File Formats", "Parallel unstructured grid", and vtkXMLPUnstructuredGridWriter.
#include "mesh_files/pvtu_reader.h"

#include "base/error.h"
#include "mesh_files/vtk_index.h"
#include "mesh_files/vtu_reader.h"

namespace lamina {

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

void add_pvtu(const std::filesystem::path& path, MeshAssembly& assembly) {
    for (const std::filesystem::path& piece : pieces_of_pvtu(path)) add_vtu(piece, assembly);
}

MeshData read_pvtu(const std::filesystem::path& path) {
    MeshAssembly assembly(path.string());
    add_pvtu(path, assembly);
    return assembly.finish();
}

}  // namespace lamina
