// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "lamina/volume.h"
#include "volume/min_max_bricks.h"
#include "volume/value_counts.h"

namespace lamina {

// The results of a pass over all samples of a volume. If the volume stays in its files, they are
// kept in a file.
struct VolumeIndex {
    MinMaxBricks bricks;
    ValueCounts values;
};

// Returns the index of a volume that stays in its files: from the index file beside them, or from
// that in the user's cache folder, if it is of these samples as they are now; else by a pass over
// the samples, on all cores, whose result is kept in the cache folder. A warning says what is wrong
// with an index that is there.
VolumeIndex index_of(const Volume& volume);

// Makes the pass, whatever index files there are.
VolumeIndex measure_index(const Volume& volume);

// Returns the name of the index file beside a volume's files.
std::filesystem::path index_file_of(const Volume& volume);
void write_index(const Volume& volume, const VolumeIndex& index, const std::filesystem::path& file);

// Writes a volume's index to a file: a line that names the format; a header of one line, in JSON;
// the values' counts or values; the ranges of bricks in pieces, each behind a byte that is 0 if the
// piece is 0 and left out; and a hash of all that follows the first line. Binary numbers are those
// of a little-endian machine. `identity`: that of the samples (SampleSource).
void write_index_file(const std::filesystem::path& file, const std::string& identity,
                      const Grid& grid, SampleType type, const VolumeIndex& index);

// Throws Error if `file` exists and is no index: it must not be replaced. A link is never followed,
// neither here nor by write_index_file().
void expect_index_or_nothing(const std::filesystem::path& file);

// An index that was read: none if the file is not there, is damaged, or is of other samples.
// `wrong` then says what is wrong with a file that is there; otherwise it is empty.
struct FoundIndex {
    std::optional<VolumeIndex> index;
    std::string wrong;
};
FoundIndex read_index_file(const std::filesystem::path& file, const std::string& identity,
                           const Grid& grid, SampleType type);

// A volume that is drawn, with its min/max bricks, which are measured once. If the volume stays in
// its files, that is a pass over all of them, or over the index that an earlier pass has left.
struct VolumeData {
    explicit VolumeData(Volume opened);

    Volume volume;
    MinMaxBricks bricks;
    std::optional<ValueCounts> values;  // only if the volume stays in its files
};

}  // namespace lamina
