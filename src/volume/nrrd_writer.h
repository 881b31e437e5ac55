// SPDX-License-Identifier: Apache-2.0
// Writes NRRD files, from which open_nrrd() reads back the same volume, bit for bit.
#pragma once

#include "base/output_file.h"
#include "lamina/volume.h"

namespace lamina {

// Writes a header; the caller must then write all samples, in native byte order, x fastest.
void write_nrrd_header(AtomicFile& file, const Grid& grid, SampleType type);

// Writes header and raw samples. Does not commit the file. Labels are written with the file's
// numbers, and what is known of them in the keys of 3D Slicer's segmentations; Slicer has no key
// for an opacity other than 1.
void write_nrrd(AtomicFile& file, const Volume& volume);

}  // namespace lamina
