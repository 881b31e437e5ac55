// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "volume/nrrd_header.h"

namespace lamina {

// Checks that the data file can hold the samples that the header promises, then takes memory and
// reads them, in native byte order. Throws Error.
std::shared_ptr<const void> read_nrrd_samples(const NrrdHeader& header);

}  // namespace lamina
