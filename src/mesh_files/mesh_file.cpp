// SPDX-License-Identifier: Apache-2.0
#include "mesh_files/mesh_file.h"

#include <algorithm>
#include <string>

#include "base/error.h"
#include "base/input_file.h"
#include "mesh_files/mesh_formats.h"

namespace lamina {
namespace {

using Path = std::filesystem::path;

MeshData read_first_of_pvd(const Path& path) {
    return read_pvd(path, 0);
}

struct MeshFormat {
    MeshData (*read)(const Path&);
    const char* mark;  // text that tells a VTK XML file; null: other formats
    std::vector<std::string> extensions;
};

// Tells if a file is of a format by its beginning (TetGen's never: numbers could mean anything).
bool holds(const MeshFormat& format, const std::string& beginning) {
    if (format.read == read_vtk) return beginning.starts_with("# vtk DataFile");
    const std::size_t tag = beginning.find("<VTKFile");
    return format.mark != nullptr && tag != std::string::npos &&
           beginning.find(format.mark, tag) != std::string::npos;
}

const MeshFormat* find_format(const Path& path) {
    expect_allowed(path);
    static const std::vector<MeshFormat> formats{{read_pvtu, "PUnstructuredGrid", {".pvtu"}},
                                                 {read_vtu, "UnstructuredGrid", {".vtu"}},
                                                 {read_first_of_pvd, "\"Collection\"", {".pvd"}},
                                                 {read_vtk, nullptr, {".vtk"}},
                                                 {read_node_ele, nullptr, {".node", ".ele"}}};
    const std::string beginning = file_beginning(path, 512);
    for (const MeshFormat& format : formats) {
        if (holds(format, beginning)) return &format;
    }
    for (const MeshFormat& format : formats) {
        if (std::ranges::count(format.extensions, path.extension().string()) > 0) return &format;
    }
    return nullptr;
}

const MeshFormat& format_of(const Path& path) {
    if (const MeshFormat* const format = find_format(path)) return *format;
    fail(
        "{}: not a mesh file: found extension '{}', expected .vtu, .pvtu, .pvd, .vtk, .node or "
        ".ele",
        path.string(), path.extension().string());
}

bool is_pvd_file(const Path& path) {
    const MeshFormat* const format = find_format(path);
    return format != nullptr && format->read == read_first_of_pvd;
}

// Appends a file, and the pieces that it names if it is a .pvtu.
void append_files(std::vector<Path>& files, const Path& part) {
    files.push_back(part);
    const MeshFormat* const format = find_format(part);
    if (format == nullptr || format->read != read_pvtu) return;
    for (const Path& piece : pieces_of_pvtu(part)) files.push_back(piece);
}

}  // namespace

bool is_mesh_file(const Path& path) {
    return find_format(path) != nullptr;
}

MeshData read_mesh(const Path& path, std::int64_t time) {
    const MeshFormat& format = format_of(path);
    if (is_pvd_file(path)) return read_pvd(path, time);
    if (time != 0)
        fail("{}: time: found {}, expected 0: the file has one step", path.string(), time);
    return format.read(path);
}

std::int64_t steps_of_mesh(const Path& path) {
    return is_pvd_file(path) ? std::ssize(steps_of_pvd(path)) : 1;
}

std::vector<Path> files_of_mesh(const Path& path) {
    std::vector<Path> files;
    append_files(files, path);
    if (is_pvd_file(path)) {
        for (const PvdStep& step : steps_of_pvd(path)) {
            for (const Path& part : step.files) append_files(files, part);
        }
    }
    const std::string extension = path.extension().string();
    if (extension == ".node" || extension == ".ele")
        files.push_back(Path(path).replace_extension(extension == ".node" ? ".ele" : ".node"));
    return files;
}

}  // namespace lamina
