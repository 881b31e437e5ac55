// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "volume/volume_index.h"

namespace lamina {

// A volume's index in a file: a line that names the format; a header of one line, in JSON; the
// values' counts or values; the ranges of bricks in pieces, each behind a byte that is 0 where the
// piece is 0 and left out; and a hash of all that follows the first line. Binary numbers are those
// of a little-endian machine. `identity`: of the samples (SampleSource).
void write_index_file(const std::filesystem::path& file, const std::string& identity,
                      const Grid& grid, SampleType type, const VolumeIndex& index);

// Throws Error if there is something at `file` that is no index: it must not be replaced. A link is
// never followed, neither here nor by write_index_file().
void expect_index_or_nothing(const std::filesystem::path& file);

// No index if the file is not there, is damaged, or is of other samples. `wrong` then says what is
// wrong with a file that is there; otherwise it is empty.
struct FoundIndex {
    std::optional<VolumeIndex> index;
    std::string wrong;
};
FoundIndex read_index_file(const std::filesystem::path& file, const std::string& identity,
                           const Grid& grid, SampleType type);

}  // namespace lamina
