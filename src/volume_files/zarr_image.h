// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "lamina/volume.h"
#include "volume_files/array_axes.h"
#include "volume_files/packed_values.h"
#include "volume_files/volume_opening.h"
#include "volume_files/zarr_chunks.h"

namespace lamina {

// A group or array of a hierarchy.
struct ZarrNode {
    std::filesystem::path folder;
    bool is_array = false;
    // Number of axes of an array. Images, and arrays without a shape, count as having many.
    std::size_t rank = 100;
    nlohmann::json attributes = nlohmann::json::object();  // the users'
};

// Reads the headers in a folder, which may have none. Throws Error.
ZarrNode zarr_node(const ZarrStore& store, const std::filesystem::path& folder);

// One array of an image, and how it lies in the world.
struct ZarrImage {
    std::filesystem::path folder;
    std::vector<ArrayAxis> axes;  // in the array's order, without sizes; empty: a plain array
    // Along each axis: the world's length of an index, and the place of index 0.
    std::vector<double> steps, firsts;
    bool has_own_axes = true;  // else they are t, c, z, y, x, of which an array may have the last
    std::vector<std::string> channels;  // names, as many as the image gives
    std::vector<std::filesystem::path> levels;
    bool is_labels = false;     // its samples are labels
    std::vector<Label> labels;  // that the image describes
};

// Returns the attributes in which OME-Zarr's metadata are: the member "ome" from version 0.5 on.
const nlohmann::json& ome_attributes(const ZarrNode& node);
bool is_ome_image(const ZarrNode& node);
// Reads an image's metadata, "multiscales". Throws Error.
ZarrImage read_ome_image(const ZarrNode& node, const std::optional<std::int64_t>& level);
// Returns the level that a folder is in the image of a node; nothing if it is none.
std::optional<std::int64_t> level_of(const ZarrNode& node, const std::filesystem::path& folder);

// Describes the axes of an array: an image's as that does, others by their names and by the arrays
// of coordinates that have these names beside the array. Throws Error.
DescribedArray describe_zarr(const ZarrArray& array, const ZarrImage& image);

// Returns what the attributes of an array say of its values. Throws Error.
PackedValues zarr_values(const ZarrArray& array);

// Reads all selected samples, in native byte order.
std::shared_ptr<void> zarr_samples(const ZarrChunks& chunks);

}  // namespace lamina
