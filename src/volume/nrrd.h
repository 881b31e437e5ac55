// SPDX-License-Identifier: Apache-2.0
// NRRD files (http://teem.sourceforge.net/nrrd/format.html). World coordinates are the file's own:
// `space origin` (or axis min) is where the first sample lies, `space directions` (or `spacings`)
// lead from sample to sample.
#pragma once

#include <filesystem>

#include "base/atomic_file.h"
#include "lamina/volume.h"

namespace lamina {

// Reads a file of three orthogonal axes (axes of one sample beyond three are dropped) of uint8,
// int16, uint16 or float samples; encodings raw, gzip, bzip2 and ascii; attached header or one
// detached data file; both byte orders. Checks what the header promises against the file's length
// before it takes memory. NaN and infinite samples are kept. Throws Error, one line that names the
// file.
Volume read_nrrd(const std::filesystem::path& path);

// Writes an attached header; grid.sample_count() samples in native byte order, x fastest, must
// follow.
void write_nrrd_header(AtomicFile& file, const Grid& grid, SampleType type);

// Header and samples, raw. read_nrrd() gives back the same volume, bit for bit. Does not commit the
// file.
void write_nrrd(AtomicFile& file, const Volume& volume);

}  // namespace lamina
