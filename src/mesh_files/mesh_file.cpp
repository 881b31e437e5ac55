// SPDX-License-Identifier: Apache-2.0
#include "mesh_files/mesh_file.h"

#include <algorithm>
#include <string>

#include "base/error.h"
#include "base/input_file.h"
#include "mesh_files/mesh_formats.h"
#include "mesh_files/vtk_xml.h"

namespace lamina {
namespace {

using Path = std::filesystem::path;

MeshData read_first_of_pvd(const Path& path, double join) {
    return read_pvd(path, 0, join);
}

struct MeshFormat {
    MeshData (*read)(const Path&, double join);
    const char* type;  // of VTK XML files; null: other formats
    std::vector<std::string> extensions;
};

const MeshFormat* find_format(const Path& path) {
    expect_allowed(path);
    static const std::vector<MeshFormat> formats{{read_pvtu, "PUnstructuredGrid", {".pvtu"}},
                                                 {read_vtu, "UnstructuredGrid", {".vtu"}},
                                                 {read_first_of_pvd, "Collection", {".pvd"}},
                                                 {read_vtk, nullptr, {".vtk"}},
                                                 {read_node_ele, nullptr, {".node", ".ele"}}};
    // Contents count before names, but for TetGen's, whose numbers could mean anything.
    const std::string type = vtk_xml_type(path);
    const bool legacy = file_beginning(path, 14) == "# vtk DataFile";
    for (const MeshFormat& format : formats) {
        const bool is_vtk_xml = format.type != nullptr && type == format.type;
        if (is_vtk_xml || (legacy && format.read == read_vtk)) return &format;
    }
    for (const MeshFormat& format : formats) {
        if (std::ranges::count(format.extensions, path.extension().string()) > 0) return &format;
    }
    return nullptr;
}

// A kind of mesh that is not read.
struct ForeignMesh {
    std::vector<std::string> types;  // of VTK XML files
    const char* mark;                // text at the beginning of other files; null: none
    const char* name;
    std::vector<std::string> extensions;
    const char* advice;
};
constexpr const char *convert = "convert it to .vtu (ParaView: File, Save Data; or meshio convert)",
                     *as_pvd =
                         "name one of the files, or make a .pvd of them (ParaView: File, Save "
                         "Data, with all time steps)",
                     *one_block =
                         "save its unstructured grid as .vtu (in ParaView after Merge "
                         "Blocks), or name the .vtu files of its blocks in a .pvtu",
                     *as_tets =
                         "make it an unstructured grid (ParaView: Append Datasets, or "
                         "Resample To Image for a volume) and save it as .vtu";

}  // namespace

void expect_no_foreign_mesh(const Path& path) {
    static const std::vector<ForeignMesh> kinds{
        {{"vtkMultiBlockDataSet"},
         nullptr,
         "VTK multi-block data set",
         {".vtm", ".vtmb"},
         one_block},
        {{"vtkPartitionedDataSet", "vtkPartitionedDataSetCollection"},
         nullptr,
         "VTK partitioned data set",
         {".vtpd", ".vtpc"},
         one_block},
        {{"vtkOverlappingAMR", "vtkNonOverlappingAMR", "vtkHierarchicalBoxDataSet"},
         nullptr,
         "VTK data set of adaptive grids",
         {".vth", ".vthb"},
         one_block},
        {{"StructuredGrid", "PStructuredGrid"},
         nullptr,
         "VTK structured (curvilinear) grid",
         {".vts", ".pvts"},
         as_tets},
        {{"PolyData", "PPolyData"},
         nullptr,
         "VTK surface (PolyData)",
         {".vtp", ".pvtp"},
         "it has no volume; lamina draws grids of tetrahedra, hexahedra, wedges and pyramids"},
        {{}, "$MeshFormat", "Gmsh or ANSYS Fluent mesh", {".msh", ".cas"}, convert},
        {{}, "<Xdmf", "XDMF data set", {".xdmf", ".xmf", ".xdmf2", ".xdmf3"}, convert},
        {{}, nullptr, "Exodus II mesh", {".exo", ".exii", ".ex2", ".e"}, convert},
        {{}, nullptr, "CGNS mesh", {".cgns"}, convert},
        {{}, nullptr, "MED mesh", {".med"}, convert},
        {{}, nullptr, "EnSight case", {".case", ".encas"}, convert},
        {{}, nullptr, "OpenFOAM case", {".foam"}, convert},
        {{}, "TITLE", "Tecplot data set", {".plt", ".szplt", ".tec"}, convert},
        {{}, "VARIABLES", "Tecplot data set", {}, convert},
        {{}, nullptr, "Abaqus or AVS (UCD) mesh", {".inp"}, convert},
        {{}, "mesh3d", "Netgen mesh", {}, convert},
        {{}, "<dolfin", "FEniCS (DOLFIN) mesh", {}, convert},
        {{}, "NDIME=", "SU2 mesh", {".su2"}, convert},
        {{}, nullptr, "Nastran mesh", {".bdf", ".nas"}, convert},
        {{}, nullptr, "I-deas mesh", {".unv"}, convert},
        {{}, nullptr, "Medit mesh", {".mesh", ".meshb"}, convert},
        {{}, nullptr, "list of files in time (ParaView)", {".series"}, as_pvd}};
    expect_allowed(path);
    std::error_code unreadable;  // such a file fails when it is read
    if (!std::filesystem::is_regular_file(path, unreadable)) return;
    const std::string beginning = file_beginning(path, 512);
    const std::string type = vtk_xml_type(path);
    const std::string extension = path.extension().string();
    const std::size_t start = beginning.find_first_not_of(" \t\r\n\xef\xbb\xbf");
    for (const ForeignMesh& kind : kinds) {
        // A file's first character tells its mark from such words in the comments of other files.
        const bool marked = type.empty() && kind.mark != nullptr && start != beginning.npos &&
                            beginning[start] == kind.mark[0] &&
                            beginning.find(kind.mark) != beginning.npos;
        const bool typed = !type.empty() && std::ranges::count(kind.types, type) > 0;
        const bool named = type.empty() && std::ranges::count(kind.extensions, extension) > 0;
        if (!marked && !typed && !named) continue;
        const bool has_vowel =
            std::string_view("AEIOUX").find(kind.name[0]) != std::string_view::npos;
        fail("{}: found {} {}, which is not read: {}", path.string(), has_vowel ? "an" : "a",
             kind.name, kind.advice);
    }
}

namespace {

const MeshFormat& format_of(const Path& path) {
    expect_no_foreign_mesh(path);
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

MeshData read_mesh(const Path& path, std::int64_t time, double join) {
    const MeshFormat& format = format_of(path);
    if (is_pvd_file(path)) return read_pvd(path, time, join);
    if (time != 0)
        fail("{}: time: found {}, expected 0: the file has one step", path.string(), time);
    return format.read(path, join);
}

std::int64_t steps_of_mesh(const Path& path) {
    return is_pvd_file(path) ? std::ssize(steps_of_pvd(path)) : 1;
}

std::vector<double> times_of_mesh(const Path& path) {
    std::vector<double> times;
    if (!is_pvd_file(path)) return times;
    for (const PvdStep& step : steps_of_pvd(path)) times.push_back(step.time);
    return times;
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
