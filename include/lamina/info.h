// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lamina/error.h"
#include "lamina/volume.h"

namespace lamina {

// Describes a volume or a mesh in a file as `lamina info --json` does (docs/info.md): its arrays,
// channels, times, levels and labels with their names, its size, values and place. Returns a JSON
// object. `request` chooses a part of the file; its `time` is a mesh's step, too. Arguments and
// errors are those of load_volume() (lamina/volume.h).
LAMINA_API std::string describe_file(const std::filesystem::path& file,
                                     const VolumeRequest& request = {},
                                     const std::filesystem::path& only_below = {},
                                     std::vector<std::string>* warnings = nullptr);

// Tells whether samples in memory are like labels (docs/scene.md, "Labels"): those of files are
// taken for such, others only if VolumeLookup::nearest says so. A mask of two values that differ by
// at most 1 is a field as well.
LAMINA_API bool look_like_labels(const Volume& volume);

}  // namespace lamina
