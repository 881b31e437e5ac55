// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "lamina/volume.h"
#include "volume_files/volume_opening.h"

namespace lamina {

// Returns the folder of a volume's bricked copy, FILE.lamina-bricks: a Zarr array with the samples
// in chunks, for files of which no part can be read alone, such as compressed ones. Its attributes
// hold the grid and a hash of what was copied; each chunk is checked by its hash when it is read.
std::filesystem::path bricked_copy_of(const std::filesystem::path& file);

// A bricked copy that was written, as messages describe it.
struct BrickedCopy {
    std::filesystem::path folder;
    std::int64_t chunks = 0;
    std::uint64_t bytes = 0;
};

// Writes the bricked copy, replacing an existing one. Reads the volume by layers of chunks if its
// files allow that. Ignores the request's spacing and origin. Leaves no new files if it fails.
BrickedCopy write_bricked_copy(const std::filesystem::path& file, const VolumeRequest& request);

// Returns the volume of the bricked copy; nothing if there is none or `use` asks for memory
// (stays_in_files()). If it is damaged or was made of other samples, warns and returns nothing.
std::optional<Volume> open_bricked_copy(const std::filesystem::path& file,
                                        const VolumeRequest& request, const VolumeUse& use);

}  // namespace lamina
