// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>

#include "lamina/volume.h"
#include "volume/sample_source.h"
#include "volume_files/stored_data.h"

namespace lamina {

// Makes a grid of which only the size is known: samples 1 apart from 0 on, each a node; the sample
// of an axis with one is a cell.
inline Grid plain_grid(const std::array<std::int64_t, 3>& size) {
    Grid grid;
    grid.size = size;
    for (std::size_t axis = 0; axis < 3; ++axis)
        grid.centering[axis] = size[axis] == 1 ? Centering::cell : Centering::node;
    return grid;
}

// The words of a format for the steps between samples and the place of the first.
struct GridWords {
    const char* directions;  // "space directions"
    const char* origin;      // "space origin"
};

// Throws Error unless all steps are finite, neither vanish nor overflow when squared, and are
// orthogonal, up to the digits that headers have. They may be oblique in the world, and mirrored.
void check_grid(const std::string& file, const Grid& grid, const GridWords& words);

// Turns a grid from these axes to those of DICOM (LPS), which are the world's. Samples stay at
// their places in the body. A grid in unnamed axes stays as it is.
void turn_to_lps(Grid& grid, WorldAxes axes);

// The use for which a volume is opened.
struct VolumeUse {
    enum class Residence {
        in_memory,
        as_fits,   // in its files if it exceeds the memory limit and can stay there
        in_files,  // in its files; Error if it cannot stay there
        in_order,  // in its files if they can be read once, from first to last
    };
    Residence residence = Residence::in_memory;
    bool lit = false;  // drawing takes memory for gradients, too
};

// Tells if a volume that can stay in its files is to do so: by the memory that it and its derived
// data for drawing take (base/memory.h).
bool stays_in_files(const Grid& grid, SampleType type, const VolumeUse& use);

// Throws Error if a volume that cannot stay in its files has to, or if its samples alone take more
// than a memory limit that somebody has set. `name`: the file's; `why`: the reason, as "its data
// are compressed".
void expect_room(const std::string& name, std::uint64_t bytes, const VolumeUse& use,
                 const std::string& why);

// Opens the volume of data that a header describes: in its files if the use allows it and memory
// has no room for it, else in memory. Throws Error.
Volume open_stored(const Grid& grid, const StoredData& data, const VolumeUse& use);

// Makes a volume that stays in its files.
Volume stored_volume(const Grid& grid, SampleType type, std::unique_ptr<const SampleSource> source);

}  // namespace lamina
