// SPDX-License-Identifier: Apache-2.0
// "VTK File Formats" (the VTK User's Guide): image data, rectilinear grids, their parallel forms,
// and ParaView's lists of files by time (.pvd).
#include <algorithm>
#include <set>
#include <sstream>

#include "base/error.h"
#include "base/input_file.h"
#include "mesh_files/mesh_formats.h"
#include "mesh_files/vtk_xml.h"
#include "volume_files/volume_formats.h"
#include "volume_files/vtk_image.h"

namespace lamina {
namespace {

using Path = std::filesystem::path;
using Node = pugi::xml_node;

constexpr std::size_t most_pieces = 4096;

bool is_image_type(const std::string& type) {
    return type == "ImageData" || type == "RectilinearGrid" || type == "PImageData" ||
           type == "PRectilinearGrid";
}

// Tells if a file of a .pvd is an image: by its name if it is not there.
bool names_image(const Path& file) {
    std::error_code absent;
    if (std::filesystem::exists(file, absent))
        return is_image_type(vtk_xml_type(file)) || is_legacy_vtk_image(file);
    const std::string extension = file.extension().string();
    return extension == ".vti" || extension == ".vtr" || extension == ".pvti" ||
           extension == ".pvtr";
}

bool is_pvd_of_images(const Path& path) {
    try {
        const Path file = steps_of_pvd(path).front().files.front();
        expect_allowed(file);
        return names_image(file);
    } catch (const Error&) {
        return false;  // read_mesh() reports it
    }
}

template <typename T, std::size_t count>
std::array<T, count> numbers_in(const VtkXmlFile& file, Node node, const char* attribute,
                                std::array<T, count> numbers, const char* expected) {
    std::istringstream stream(node.attribute(attribute).value());
    std::string more;
    bool good = true;
    for (T& number : numbers) good &= static_cast<bool>(stream >> number);
    if (!good || stream >> more) {
        fail("{}: {}: found '{}', expected {}", file.name(), attribute,
             one_line(node.attribute(attribute).value()).substr(0, 80), expected);
    }
    return numbers;
}

VtkExtent extent_of(const VtkXmlFile& file, Node node, const char* attribute) {
    constexpr std::int64_t largest = std::int64_t{1} << 40;
    constexpr const char* expected = "first and last point along x, y and z";
    const auto numbers = numbers_in<std::int64_t, 6>(file, node, attribute, {}, expected);
    VtkExtent extent;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        extent.first[axis] = numbers[2 * axis];
        extent.last[axis] = numbers[2 * axis + 1];
        if (extent.first[axis] < -largest || extent.last[axis] > largest ||
            extent.first[axis] > extent.last[axis]) {
            fail("{}: {}: found '{}', expected {}", file.name(), attribute,
                 one_line(node.attribute(attribute).value()).substr(0, 80), expected);
        }
    }
    return extent;
}

// Returns the places of image data; nothing if the parts of a rectilinear grid have them.
std::optional<VtkGeometry> geometry_of(const VtkXmlFile& file, const std::string& type) {
    if (!type.ends_with("ImageData")) return {};
    VtkGeometry places;
    const auto read = [&](const char* attribute, auto& numbers, const char* expected) {
        if (file.grid().attribute(attribute))
            numbers = numbers_in(file, file.grid(), attribute, numbers, expected);
    };
    read("Origin", places.origin, "3 numbers");
    read("Spacing", places.spacing, "3 numbers");
    read("Direction", places.direction, "9 numbers");
    return places;
}

std::vector<VtkImageArray> vtk_arrays_of(const VtkXmlFile& file, Node piece) {
    std::vector<VtkImageArray> arrays;
    for (const char* const section : {"PointData", "CellData"}) {
        for (const Node node : piece.child(section).children("DataArray")) {
            const std::string_view type = node.attribute("type").value();
            if (type == "String" || type == "Bit") continue;
            const bool of_cells = std::string_view(section) == "CellData";
            VtkImageArray array{node.attribute("Name").value(), of_cells, 1, {}};
            const std::string what = fmt::format("{}: '{}'", file.name(), one_line(array.name));
            array.components = file.components_of(node, what);
            constexpr std::int64_t most = 65536;
            if (array.components > most)
                fail("{}: found {} components, expected at most {}", what, array.components, most);
            for (std::int64_t i = 0; i < array.components; ++i) {
                const auto named = node.attribute(fmt::format("ComponentName{}", i).c_str());
                if (!named) break;
                array.component_names.emplace_back(named.value());
            }
            arrays.push_back(std::move(array));
        }
    }
    return arrays;
}

std::array<std::vector<double>, 3> coordinates_of(const VtkXmlFile& file, Node piece,
                                                  const VtkExtent& extent) {
    std::array<std::vector<double>, 3> coordinates;
    std::size_t axis = 0;
    for (const Node array : piece.child("Coordinates").children("DataArray")) {
        if (axis == 3) break;
        coordinates[axis] =
            file.values<double>(array, extent.last[axis] - extent.first[axis] + 1, 1,
                                fmt::format("{}: {} coordinates", file.name(), "xyz"[axis]));
        ++axis;
    }
    if (axis < 3) fail("{}: Coordinates: found {} arrays, expected 3", file.name(), axis);
    return coordinates;
}

// Returns a piece of a file, which must outlive it.
VtkImagePart part_of(const VtkXmlFile& file, Node piece, bool rectilinear) {
    VtkImagePart part;
    part.extent = extent_of(file, piece, "Extent");
    part.arrays = vtk_arrays_of(file, piece);
    for (const char* const section : {"PointData", "CellData"})
        if (part.scalars.empty()) part.scalars = piece.child(section).attribute("Scalars").value();
    part.values = [&file, piece](const VtkImageArray& array, std::int64_t tuples,
                                 const std::string& what) {
        const Node section = piece.child(array.of_cells ? "CellData" : "PointData");
        const Node node = section.find_child([&](Node one) {
            return std::string_view(one.name()) == "DataArray" &&
                   one.attribute("Name").value() == array.name;
        });
        return file.stored_values(node, tuples, array.components, what);
    };
    if (rectilinear) part.coordinates = coordinates_of(file, piece, part.extent);
    return part;
}

// Returns the pieces of a file. Throws Error if there are none or very many.
std::vector<Node> vtk_pieces_of(const VtkXmlFile& file) {
    const auto range = file.grid().children("Piece");
    std::vector<Node> pieces(range.begin(), range.end());
    if (pieces.empty()) fail("{}: no <Piece> in it", file.name());
    if (pieces.size() > most_pieces) {
        fail("{}: found {} pieces, expected at most {}", file.name(), pieces.size(), most_pieces);
    }
    return pieces;
}

using Add = std::function<void(const VtkImagePart&)>;

void add_pieces(const VtkXmlFile& file, bool rectilinear, const Add& add) {
    const VtkExtent whole = extent_of(file, file.grid(), "WholeExtent");
    int number = 0;
    for (const Node piece : vtk_pieces_of(file)) {
        const VtkImagePart part = part_of(file, piece, rectilinear);
        ++number;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (part.extent.first[axis] < whole.first[axis] ||
                part.extent.last[axis] > whole.last[axis])
                fail("{}: Piece {}: its Extent is none within the WholeExtent", file.name(),
                     number);
        }
        add(part);
    }
}

// The files of the pieces of a .pvti or .pvtr, relative to its folder.
std::vector<Path> sources_of(const Path& path, const VtkXmlFile& index) {
    std::vector<Path> files;
    std::set<Path> seen;
    for (const Node piece : vtk_pieces_of(index)) {
        const std::string source = piece.attribute("Source").value();
        if (source.empty())
            fail("{}: Piece {}: Source: found none, expected a file", index.name(),
                 files.size() + 1);
        files.push_back(path.parent_path() / source);
        std::error_code unreadable;  // such a file fails when it is read
        const Path canonical = std::filesystem::weakly_canonical(files.back(), unreadable);
        if (!seen.insert(unreadable ? files.back() : canonical).second) {
            fail("{}: Piece {}: found the file {} twice, expected each once", index.name(),
                 files.size(), one_line(files.back().string()));
        }
    }
    return files;
}

// Reads a .pvti or .pvtr, whose pieces are files and may overlap by ghosts.
Volume open_parallel(const Path& path, const std::string& type, const VolumeRequest& request,
                     const VolumeUse& use) {
    const VtkXmlFile index(path, type.c_str());
    VtkImageHead head{index.name(), 0, extent_of(index, index.grid(), "WholeExtent"),
                      geometry_of(index, type)};
    const std::vector<Path> files = sources_of(path, index);
    for (const Path& file : files) {
        expect_named_file(file, fmt::format("piece of {}", index.name()));
        head.bytes += std::filesystem::file_size(file);
    }
    const std::string type_of_piece = type.substr(1);
    const auto for_parts = [&](const Add& add) {
        for (const Path& file : files)
            add_pieces(VtkXmlFile(file, type_of_piece.c_str()), !head.geometry, add);
    };
    return joined_vtk_image(head, for_parts, request, use);
}

Volume open_single(const Path& path, const std::string& type, const VolumeRequest& request,
                   const VolumeUse& use) {
    const VtkXmlFile file(path, type.c_str());
    const VtkImageHead head{file.name(), file.byte_count(),
                            extent_of(file, file.grid(), "WholeExtent"), geometry_of(file, type)};
    return joined_vtk_image(
        head, [&](const Add& add) { add_pieces(file, !head.geometry, add); }, request, use);
}

Volume open_pvd(const Path& path, VolumeRequest request, const VolumeUse& use) {
    const std::vector<PvdStep> steps = steps_of_pvd(path);
    const std::int64_t step = taken_of(path.string(), "time", request.time, std::ssize(steps));
    const std::vector<Path>& files = steps[static_cast<std::size_t>(step)].files;
    if (files.size() > 1) {
        fail("{}: step {}: found {} files, expected one: a .pvti or .pvtr joins pieces",
             path.string(), step, files.size());
    }
    if (use.contents != nullptr)
        for (const PvdStep& one : steps) use.contents->times.push_back(fmt::format("{}", one.time));
    const std::string what = fmt::format("step {} of {}", step, path.string());
    expect_named_file(files[0], what);
    if (!names_image(files[0]))
        fail("{}: {}: expected an image, as at the first step", files[0].string(), what);
    request.time.reset();
    return open_vti(files[0], request, use);
}

}  // namespace

void refuse_vtk_type(const std::string& file, const std::string& type) {
    const char* advice = "draw one of the files that it names";
    if (type.find("tructured") != std::string::npos || type.find("HyperTree") != std::string::npos)
        advice = "ParaView's filter Resample To Image makes image data of such a grid";
    if (type.find("Table") != std::string::npos) advice = "a table has no places";
    if (type.find("oly") != std::string::npos)
        advice = "a surface has no samples between its faces";
    fail(
        "{}: found a VTK file of type {}, expected image data, a rectilinear grid with even "
        "steps, or an unstructured grid: {}",
        file, one_line(type), advice);
}

bool is_vti(const Path& path) {
    const std::string type = vtk_xml_type(path);
    if (type == "Collection") return is_pvd_of_images(path);
    if (type.empty()) return is_legacy_vtk_image(path);
    constexpr const char* refused[] = {"StructuredGrid", "PolyData", "HyperTreeGrid", "Table"};
    return is_image_type(type) || type.starts_with("vtk") ||
           std::ranges::any_of(refused, [&](const std::string& word) {
               return type == word || type == "P" + word;
           });
}

Volume open_vti(const Path& path, const VolumeRequest& request, const VolumeUse& use) {
    const std::string type = vtk_xml_type(path);
    if (type == "Collection") return open_pvd(path, request, use);
    taken_axis(path.string(), "time", request.time, 1);
    if (type.empty() && is_legacy_vtk_image(path)) return open_legacy_vtk_image(path, request, use);
    if (!type.empty() && !is_image_type(type)) refuse_vtk_type(path.string(), type);
    if (type.starts_with("P")) return open_parallel(path, type, request, use);
    return open_single(path, type.empty() ? "ImageData" : type, request, use);
}

std::vector<Path> files_of_vti(const Path& path) {
    std::vector<Path> files;
    const auto append = [&](const Path& file) {
        files.push_back(file);
        expect_allowed(file);
        const std::string type = vtk_xml_type(file);
        if (type != "PImageData" && type != "PRectilinearGrid") return;
        for (const Path& piece : sources_of(file, VtkXmlFile(file, type.c_str())))
            files.push_back(piece);
    };
    append(path);
    if (vtk_xml_type(path) != "Collection") return files;
    for (const PvdStep& step : steps_of_pvd(path))
        for (const Path& file : step.files) append(file);
    return files;
}

}  // namespace lamina
