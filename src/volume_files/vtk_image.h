// SPDX-License-Identifier: Apache-2.0
// Images in files of VTK: image data and rectilinear grids with even steps, XML or legacy, which
// are put together from parts.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "mesh_files/vtk_xml.h"
#include "volume_files/volume_opening.h"

namespace lamina {

// A box of points: the first and the last one along each axis.
struct VtkExtent {
    std::array<std::int64_t, 3> first{}, last{};

    bool operator==(const VtkExtent&) const = default;
};

// An array of numbers in a part.
struct VtkImageArray {
    std::string name;
    bool of_cells = false;
    std::int64_t components = 1;
    std::vector<std::string> component_names;  // of the first ones, if the file names them
};

// A part of an image: a piece of an XML file, or a legacy file.
struct VtkImagePart {
    VtkExtent extent;
    std::vector<VtkImageArray> arrays;  // those of points first
    std::string scalars;                // the array that the file calls its scalars, if any
    // Returns the values of all components in their own type. `what`: for messages.
    std::function<VtkXmlValues(const VtkImageArray& array, std::int64_t tuples,
                               const std::string& what)>
        values;
    // Places of a rectilinear grid's points along each axis; empty for image data.
    std::array<std::vector<double>, 3> coordinates;
};

// Places of the points of image data.
struct VtkGeometry {
    std::array<double, 3> origin{0, 0, 0}, spacing{1, 1, 1};
    std::array<double, 9> direction{1, 0, 0, 0, 1, 0, 0, 0, 1};
};

// The data of an image that are known before its parts are read.
struct VtkImageHead {
    std::string file;         // the one that the user names
    std::uint64_t bytes = 0;  // of all files of the image
    VtkExtent whole;
    std::optional<VtkGeometry> geometry;  // none if the parts have coordinates
};

// Puts an image together. `for_parts` calls its argument for each part; together they must have all
// samples. What lies outside of the whole image is cut off; of values that several parts have,
// ghosts, the last are taken. What ghost arrays hide becomes NaN. Throws Error.
Volume joined_vtk_image(
    const VtkImageHead& head,
    const std::function<void(const std::function<void(const VtkImagePart&)>& add)>& for_parts,
    const VolumeRequest& request, const VolumeUse& use);

// Legacy files, for open_vti().
bool is_legacy_vtk_image(const std::filesystem::path& path);
Volume open_legacy_vtk_image(const std::filesystem::path& path, const VolumeRequest& request,
                             const VolumeUse& use);

// Throws Error about a kind of VTK file that is no volume. `type`: the file's word for the kind.
[[noreturn]] void refuse_vtk_type(const std::string& file, const std::string& type);

}  // namespace lamina
