// SPDX-License-Identifier: Apache-2.0
// MetaImage files (.mha, .mhd), as ITK writes them: https://itk.org/Wiki/ITK/MetaIO/Documentation
#pragma once

#include <filesystem>
#include <vector>

#include "lamina/volume.h"
#include "lamina/volume_request.h"
#include "volume_files/volume_opening.h"

namespace lamina {

// By its first key.
bool is_metaimage(const std::filesystem::path& path);

// Reads an image of three dimensions, or four, of which the last is time; of all element types,
// with channels; binary, compressed or as text; in the file itself, in another, in a list or a
// numbered series. `Offset` is the first sample's place, the rows of `TransformMatrix` are the
// axes; where `AnatomicalOrientation` tells directions, the world's axes are LPS, as ITK has them.
// Throws Error.
Volume read_metaimage(const std::filesystem::path& path, const VolumeRequest& request);

// The file and its data files. Throws Error.
// The same; it may stay in its files (volume_files/volume_opening.h).
Volume open_metaimage(const std::filesystem::path& path, const VolumeRequest& request,
                      const VolumeUse& use);

std::vector<std::filesystem::path> files_of_metaimage(const std::filesystem::path& path);

}  // namespace lamina
