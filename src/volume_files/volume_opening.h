// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lamina/volume.h"
#include "volume/sample_source.h"
#include "volume_files/stored_data.h"

namespace lamina {

// Makes a grid by its size alone: nodes 1 apart from 0 on; an axis of one sample is a cell.
inline Grid plain_grid(const std::array<std::int64_t, 3>& size) {
    Grid grid;
    grid.size = size;
    for (std::size_t axis = 0; axis < 3; ++axis)
        grid.centering[axis] = size[axis] == 1 ? Centering::cell : Centering::node;
    return grid;
}

// How messages name the steps between samples and the place of the first, in the words of a format.
struct GridWords {
    const char* directions;  // "space directions"
    const char* origin;      // "space origin"
};

// Throws Error unless all steps are finite, neither vanish nor overflow when squared, and are
// orthogonal within .1 degree. They may be oblique and mirrored. Directions that headers' digits do
// not explain are turned to the nearest orthogonal ones, and a warning says how far that moves
// samples. `file`: for messages.
void check_grid(const std::string& file, Grid& grid, const GridWords& words);

// Returns the step across an image of two axes with these steps: as long as the shorter one, at a
// right angle to both; to the first if they are parallel, and 0 if one is, which check_grid()
// refuses.
glm::dvec3 slice_step(const glm::dvec3& first, const glm::dvec3& second);

// Converts a grid from world axes `axes` to those of DICOM (LPS), which are lamina's. Samples stay
// at their places in the body. A grid in unnamed axes stays as it is.
void turn_to_lps(Grid& grid, WorldAxes axes);

// Returns a unit as Grid::unit has it: without blanks around it; empty if what was found in a file
// is no such word: longer than 32 bytes, or with control characters or quotes.
std::string unit_word(std::string_view found);

// Returns how many metres a unit of lengths has; 0 if it is none, or unknown.
double metres_of(std::string_view unit);

// Brings lengths along the world's axes, which have these units (empty: none), to the unit of x, or
// of the first axis that has one. Other units than lengths that differ are said.
void unite_units(const std::string& file, Grid& grid, const std::array<std::string, 3>& units);

// Lists what a file has of which a volume is one part, with the file's names; a part without a name
// has an empty one.
struct VolumeContents {
    std::vector<std::string> arrays, channels, times;
    std::vector<std::array<std::int64_t, 3>> levels;  // their samples along x, y and z
    bool is_colour = false;                           // the channels are R, G, B (and A)
};

// The use for which a volume is opened, and so where its samples are to be.
struct VolumeUse {
    enum class Residence {
        in_memory,
        as_fits,   // in its files if it exceeds the memory limit and can stay there
        in_files,  // in its files; Error if it cannot stay there
        in_order,  // in its files if these can be read once, in order
    };
    Residence residence = Residence::in_memory;
    bool lit = false;                      // drawing takes memory for gradients, too
    VolumeContents* contents = nullptr;    // if set, filled by the reader
    std::optional<VolumeLookup> lookup{};  // VolumeRequest::lookup
};

// Takes samples for labels because the file says that they are, unless the user says how samples
// are looked up. `who`: what of the file says so, for a warning.
void take_for_labels(const std::string& file, const std::string& who, const VolumeUse& use,
                     Grid& grid);

// Tells if a volume that can stay in its files is to do so: by use.residence; for as_fits, if it
// and its derived data for drawing exceed the memory limit (base/memory.h).
bool stays_in_files(const Grid& grid, SampleType type, const VolumeUse& use);

// Throws Error if a volume that cannot stay in its files has to, or if its samples alone exceed the
// user's memory limit. `name`: the file's; `why`: the reason, such as "its data are not raw".
void expect_room(const std::string& name, std::uint64_t bytes, const VolumeUse& use,
                 const std::string& why);

// Opens data as a volume: in their files if possible and asked for, else in memory. Throws Error.
Volume open_stored(const Grid& grid, const StoredData& data, const VolumeUse& use);

Volume stored_volume(const Grid& grid, SampleType type, std::unique_ptr<const SampleSource> source);

}  // namespace lamina
