// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volume_files/nrrd_header.h"
#include "volume_files/stored_samples.h"

namespace lamina {

// Reads the samples of the header's grid. It takes memory only after it has checked that the data
// files can hold the samples that the header promises. Throws Error.
StoredSamples read_nrrd_samples(const NrrdHeader& header);

}  // namespace lamina
