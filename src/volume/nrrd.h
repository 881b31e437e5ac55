// SPDX-License-Identifier: Apache-2.0
// NRRD files (http://teem.sourceforge.net/nrrd/format.html). World coordinates are the file's own:
// `space origin` (or axis min) is the position of the first sample, and `space directions` (or
// `spacings`) are the steps between samples.
#pragma once

#include <filesystem>

#include "base/atomic_file.h"
#include "lamina/volume.h"

namespace lamina {

// Reads a file of three orthogonal axes (axes of one sample beyond three are dropped) of uint8,
// int16, uint16 or float samples. Encodings are raw, gzip, bzip2 and ascii; the header is attached
// or names one data file; both byte orders are read. The sizes in the header are checked against
// the file's length before memory is taken. NaN and infinite samples are kept. Throws Error, one
// line that names the file.
Volume read_nrrd(const std::filesystem::path& path);

// Writes an attached header. The caller must then write grid.sample_count() samples in native byte
// order, x fastest.
void write_nrrd_header(AtomicFile& file, const Grid& grid, SampleType type);

// Writes header and raw samples. read_nrrd() gives back the same volume, bit for bit. Does not
// commit the file.
void write_nrrd(AtomicFile& file, const Volume& volume);

}  // namespace lamina
