// SPDX-License-Identifier: Apache-2.0
#pragma once
// MetaImage files (.mha, .mhd), as ITK writes them: https://itk.org/Wiki/ITK/MetaIO/Documentation

#include <filesystem>
#include <vector>

#include "lamina/volume.h"
#include "lamina/volume_request.h"
#include "volume_files/volume_opening.h"

namespace lamina {

// Tells a MetaImage by its first key.
bool is_metaimage(const std::filesystem::path& path);

// Reads an image of three dimensions, or of four, the last of which is time; of all element types,
// with channels; binary, compressed or as text; in the file itself, in another, in a list or in a
// numbered series. `Offset` is the first sample's place, the rows of `TransformMatrix` are the
// axes. If `AnatomicalOrientation` names directions, the world's axes are LPS, as ITK has them.
// Throws Error.
Volume open_metaimage(const std::filesystem::path& path, const VolumeRequest& request = {},
                      const VolumeUse& use = {});

// Returns the file and its data files. Throws Error.
std::vector<std::filesystem::path> files_of_metaimage(const std::filesystem::path& path);

}  // namespace lamina
