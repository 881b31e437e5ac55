// SPDX-License-Identifier: Apache-2.0
// A head made of analytic shapes: as a CT would show it, and as a map of its tissues.
#pragma once

#include "lamina/volume.h"

namespace lamina {

// Returns Hounsfield units as int16 in steps of 1.5 mm, 128 x 160 x 160 samples, in a patient's
// axes (left, posterior, superior), with the noise of a scanner. Parallel, with progress.
Volume head_ct();

// Returns the tissue of each voxel of head_ct() as uint8, with names and colours; 0 is none.
Volume head_labels();

}  // namespace lamina
