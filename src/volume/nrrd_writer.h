// SPDX-License-Identifier: Apache-2.0
// Writes NRRD files, from which open_nrrd() reads back the same volume, bit for bit.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "base/output_file.h"
#include "lamina/volume.h"

namespace lamina {

// A label of a segmentation, in the words of 3D Slicer.
struct NrrdSegment {
    std::int64_t value = 0;  // of its samples
    std::string name;
    std::array<double, 3> color{};  // display values, 0..1
};

// Contents of a file beside one volume of numbers.
struct NrrdExtras {
    std::int64_t times = 1;     // volumes, one after the other; more than 1: a time axis
    double time_step = 1;       // from one to the next
    std::string time_unit{};    // empty: none is written
    std::string sample_unit{};  // likewise
    std::vector<NrrdSegment> segments{};
};

// Writes a header; the caller must then write all samples, in native byte order, x fastest.
void write_nrrd_header(AtomicFile& file, const Grid& grid, SampleType type,
                       const NrrdExtras& extras = {});

// Writes header and raw samples. Does not commit the file.
void write_nrrd(AtomicFile& file, const Volume& volume);

}  // namespace lamina
