// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "lamina/volume.h"
#include "lamina/volume_request.h"
#include "volume_files/volume_opening.h"

namespace lamina {

// Tells a NIfTI file by its header, packed or not. Both files of a pair are recognized.
bool is_nifti(const std::filesystem::path& path);

// Reads NIfTI-1 and NIfTI-2, a single file or a pair, of any real type, or of RGB and RGBA, whose
// colours are channels. The fourth axis is time; the fifth, of vectors, is channels. scl_slope and
// scl_inter are applied. Throws Error.
Volume open_nifti(const std::filesystem::path& path, const VolumeRequest& request = {},
                  const VolumeUse& use = {});

// Returns the file, or both of a pair. Throws Error.
std::vector<std::filesystem::path> files_of_nifti(const std::filesystem::path& path);

}  // namespace lamina
