// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "lamina/volume.h"
#include "volume/min_max_bricks.h"
#include "volume/value_counts.h"

namespace lamina {

// What a pass over all samples of a volume tells, kept in a file for volumes that stay in theirs.
struct VolumeIndex {
    MinMaxBricks bricks;
    ValueCounts values;
};

// Of a volume that stays in its files: from the index file beside them, or from that in the user's
// cache folder, if it is of these samples as they are now; else by a pass over the samples, on all
// cores, whose result is kept in the cache folder. A warning says what is wrong
// with an index that is there.
VolumeIndex index_of(const Volume& volume);

// The pass alone.
VolumeIndex measure_index(const Volume& volume);

// The index file beside a volume's files.
std::filesystem::path index_file_of(const Volume& volume);
void write_index(const Volume& volume, const VolumeIndex& index, const std::filesystem::path& file);

}  // namespace lamina
