// SPDX-License-Identifier: Apache-2.0
// Writes NRRD files, from which open_nrrd() (volume_files/volume_formats.h) gives back the same
// volume, bit for bit.
#pragma once

#include "base/output_file.h"
#include "lamina/volume.h"

namespace lamina {

// Writes a header that its data follow in the same file: the caller must then write
// grid.sample_count() samples in native byte order, x fastest.
void write_nrrd_header(AtomicFile& file, const Grid& grid, SampleType type);

// Writes header and raw samples. Does not commit the file.
void write_nrrd(AtomicFile& file, const Volume& volume);

}  // namespace lamina
