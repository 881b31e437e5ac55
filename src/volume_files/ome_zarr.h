// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

namespace lamina {

// One array of an image, and what its axes mean.
struct ZarrImage {
    std::filesystem::path folder;            // of the array
    std::vector<std::string> axes;           // "t", "c", "z", "y" or "x", in the array's order
    std::vector<double> scale, translation;  // of each axis, to the world
};

// The attributes (.zattrs) of a folder; an empty object where there are none. Throws Error.
nlohmann::json zarr_attributes(const std::filesystem::path& folder);

// Whether the attributes are those of an OME-Zarr image.
bool is_ome_zarr(const nlohmann::json& attributes);

// The wanted level of an OME-Zarr image (version 0.4 and before), 0 the finest; the first unless
// told, and then a warning says so. Throws Error.
ZarrImage ome_zarr_level(const std::filesystem::path& folder, const nlohmann::json& attributes,
                         const std::optional<std::int64_t>& level);

}  // namespace lamina
