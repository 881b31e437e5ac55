// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <set>
#include <string>
#include <vector>

#include "volume_files/stored_samples.h"

namespace lamina {

// The tags of a TIFF file that its description is read with. A page has samples * depth planes.
struct TiffBeginning {
    std::string file;                    // for messages
    std::string description;             // the first page's
    std::array<std::int64_t, 2> size{};  // pixels of a page along x and y
    std::int64_t samples = 1;            // of a pixel
    bool is_contiguous = true;           // these lie beside each other
    bool is_colour = false;              // these are red, green and blue
    std::int64_t depth = 1;              // images in a page, one behind the other
    std::int64_t pages = 1;              // of the file, without smaller copies
    std::array<double, 2> resolution{};  // pixels per unit along x and y; 0: unknown
    int resolution_unit = 1;             // 1: none, 2: inch, 3: centimetre
};

// An axis of a stack's planes: 'Z', 'C' (channels), 'T' (times) or '?', which nothing names.
struct TiffAxis {
    char letter;
    std::int64_t size;
    std::vector<std::string> names{};  // of channels or times; or none
};

// The meaning of a stack's planes, as a description says it.
struct TiffDescription {
    // A page of an OME data set: its file (-1: none has it) and its number there.
    struct Page {
        std::int32_t file = -1;
        std::uint32_t number = 0;
    };

    std::string writer;          // "ImageJ", "OME" or "tifffile"; empty: pages are slices
    std::vector<TiffAxis> axes;  // of planes, fastest first
    glm::dvec3 spacing{1, 1, 1}, origin{0, 0, 0};
    bool says_thickness = false;  // spacing along z
    std::string unit;
    double scale = 1, shift = 0;         // StoredSamples::scale and offset
    std::string type;                    // of samples, as OME calls it
    std::array<std::int64_t, 2> size{};  // pixels of OME's planes along x and y
    std::vector<std::string> files;      // OME's; the first is the one that is read
    std::vector<Page> pages;             // OME's, in the order of `axes`
    std::vector<std::string> images;     // OME's, of which one is described
};

// Reads what ImageJ and tifffile write. Warns of what is not used, and of descriptions of other
// programs. Throws Error if it contradicts the pages.
TiffDescription tiff_description(const TiffBeginning& first);

// OME's XML (https://docs.openmicroscopy.org/ome-model/6.3.1/ome-tiff/specification.html).
inline bool is_ome(const std::string& description) {
    return description.find("<OME") != std::string::npos ||
           description.find(":OME ") != std::string::npos;
}

// The files that the XML names: those with planes, and one to which it leaves the metadata.
struct OmeFiles {
    std::set<std::string> planes;
    std::string metadata;  // empty: none
};
OmeFiles files_of_ome(const std::string& description);

// Reads the XML. `image`: the name or ID of an image; empty: the first with a plane in the file
// `own`. `pages_of` counts a file's pages. Warns and throws as tiff_description() does.
using OmePagesOf = std::function<std::int64_t(const std::string&)>;
TiffDescription ome_description(const TiffBeginning& first, const std::string& own,
                                const std::string& image, const OmePagesOf& pages_of);

// Sets an axis's distance between samples. All are brought to the unit of x, which is set first.
void set_distance(TiffDescription& to, const std::string& file, int axis, double distance,
                  const std::string& unit);

bool is_distance(double number);

[[noreturn]] void fail_as_mixed(const std::string& file, std::int64_t channels,
                                std::int64_t samples);

}  // namespace lamina
