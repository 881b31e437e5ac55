// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "lamina/volume.h"
#include "lamina/volume_request.h"
#include "volume_files/volume_opening.h"

namespace lamina {

// Reads samples that lie in a file without a header, as request.raw says: x fastest, one apart from
// the origin on, as nodes. Throws Error where the file is too short.
Volume read_raw(const std::filesystem::path& path, const VolumeRequest& request);
// The same; it may stay in its file (volume_files/volume_opening.h).
Volume open_raw(const std::filesystem::path& path, const VolumeRequest& request,
                const VolumeUse& use);

}  // namespace lamina
