// SPDX-License-Identifier: Apache-2.0
// A ball of cells as a fluorescence microscope would show it.
#pragma once

#include "lamina/volume.h"

namespace lamina {

// Returns uint8 in steps of 0.3 x 0.3 x 0.6 micrometres, 144 x 144 x 72 samples: bright nuclei, one
// of them dividing, faint membranes, and noise of light. Parallel, with progress.
Volume cells_volume();

}  // namespace lamina
