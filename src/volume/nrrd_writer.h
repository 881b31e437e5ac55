// SPDX-License-Identifier: Apache-2.0
// Writes NRRD files, from which open_nrrd() reads back the same volume, bit for bit.
#pragma once

#include <cstdint>
#include <string>

#include "base/output_file.h"
#include "lamina/volume.h"

namespace lamina {

// Key under which write_nrrd() says "nearest" or "linear" (VolumeLookup) if readers could think
// otherwise.
inline constexpr const char* nrrd_lookup_key = "lamina_lookup";

// The times of a file that holds a volume for each of several.
struct NrrdTimes {
    std::int64_t count = 1;  // more than 1: a time axis, the slowest
    double step = 1;         // from one to the next
    std::string unit{};      // empty: none is written
};

// Writes a header; the caller must then write all samples, in native byte order, x fastest.
void write_nrrd_header(AtomicFile& file, const Grid& grid, SampleType type,
                       const NrrdTimes& times = {});

// Writes header and raw samples. Does not commit the file. Labels are written with the file's
// numbers, and what is known of them in the keys of 3D Slicer's segmentations; Slicer has no key
// for an opacity other than 1.
void write_nrrd(AtomicFile& file, const Volume& volume);

}  // namespace lamina
