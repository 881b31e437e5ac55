// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "lamina/color.h"
#include "lamina/scene.h"
#include "lamina/transfer_function.h"
#include "lamina/volume.h"
#include "optics/opacity.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// Function between two points (docs/scene.md). linear: opacity is linear if both points give it,
// else extinction is. extinction: extinction is linear. nearest: as at the nearest point.
enum class PointInterpolation { linear, extinction, nearest };
const char* name_of(PointInterpolation interpolation);

// A transfer function as a scene file gives it (docs/scene.md): points, perhaps with a colour map.
struct GivenTransfer {
    double unit_length = 1;  // world units that opacities refer to, > 0
    PointInterpolation interpolation = PointInterpolation::linear;
    std::vector<GivenPoint> points;   // empty: the colour map's own opacities
    std::string colormap;             // name of a shipped map, or path of a file; empty: none
    std::optional<Colormap> map;      // the colour map as read, at its own values
    Auto<ValueRange> colormap_range;  // range that the map is stretched over
    bool codes = false;               // TransferFunction::of_codes()
    std::string codes_of;             // TransferFunction::labels()
    std::string place;                // file and key, for messages: "scene.json: transfer_function"

    // Tells whether the map is stretched over the range of the data.
    bool open() const { return map && colormap_range.is_automatic() && !map->own_range; }
    // Returns the file that the map is read from; empty if there is none.
    std::filesystem::path colormap_file() const;
};

// A mistake in key `which` of a given transfer function. The message names no file and key.
class GivenTransferError : public Error {
  public:
    GivenTransferError(std::string which, const std::string& text)
        : Error(text), key(std::move(which)) {}
    std::string key;
};

// Largest |scalar| of a map's range: differences stay finite (lamina/transfer_function.h).
inline constexpr double largest_map_value = 1e300;

// Returns a function of the numbers of a volume's labels as one of their codes (VolumeLabels): each
// label keeps its optics. Returns other functions, and those of other volumes, as they are. Throws
// GivenTransferError if the function is one of the codes of other labels. Warns if a double does
// not tell two numbers apart.
TransferFunction over_codes(const TransferFunction& function, const Volume& volume);

// Makes the transfer function. `data`: the range that an open map is stretched over; a single value
// gets the middle of the map. Throws GivenTransferError if points and map make no function.
TransferFunction transfer_function_of(const GivenTransfer& given, const ValueRange& data = {});

// Tells whether the scene's transfer function is chosen from the data.
bool chooses_transfer_function(const Scene& scene);
// Tells whether the scene's colours are those of a map that is stretched over the data.
bool has_open_colormap(const Scene& scene);
// Stretches an open colour map over data of this range. Throws Error, which names file and key.
void close_colormap(Scene& scene, const ValueRange& data);

std::filesystem::path colormap_file_of(const Scene& scene);

// Returns a warning if extinction runs linearly to a point of opacity 1, of finite optical depth.
std::optional<std::string> opaque_ramp(const Scene& scene);
std::optional<std::string> opaque_ramp(const GivenTransfer& given);

}  // namespace lamina
