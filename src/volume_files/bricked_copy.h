// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "lamina/volume.h"
#include "volume_files/volume_opening.h"

namespace lamina {

// A copy of a volume's samples beside its files, as FILE.lamina-bricks: a Zarr array of chunks, for
// files of which no part can be read alone. Its attributes name what it is a copy of, and the
// volume's grid; hashes of its chunks are checked as they are read.
std::filesystem::path bricked_copy_of(const std::filesystem::path& file);

// A copy that was written, for messages.
struct BrickedCopy {
    std::filesystem::path folder;
    std::int64_t chunks = 0;
    std::uint64_t bytes = 0;
};

// Writes the copy, and replaces one that is there. The volume is read slice by slice if its files
// allow that. Distances and origin of the request do not matter. Throws Error, and then leaves
// nothing.
BrickedCopy write_bricked_copy(const std::filesystem::path& file, const VolumeRequest& request);

// Returns the volume of the copy, if there is one and the volume stays in files by this use. A
// warning says if the files are not those that were copied, or if another part of them is
// requested.
std::optional<Volume> open_bricked_copy(const std::filesystem::path& file,
                                        const VolumeRequest& request, const VolumeUse& use);

}  // namespace lamina
