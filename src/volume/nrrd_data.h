// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "volume/nrrd_header.h"

namespace lamina {

// Reads the samples, in native byte order. It takes memory only after it has checked that the data
// file can hold the samples that the header promises. Throws Error.
std::shared_ptr<const void> read_nrrd_samples(const NrrdHeader& header);

}  // namespace lamina
