// SPDX-License-Identifier: Apache-2.0
// Data of `lamina example`, made by formulas. All are made in parallel, with progress.
#pragma once

#include <cstdint>
#include <vector>

#include "lamina/volume.h"

namespace lamina {

// Returns a ball of cells as a fluorescence microscope would show it: uint8 in steps of 0.3 x 0.3 x
// 0.6 micrometres, 144 x 144 x 72 samples: bright nuclei, one of them dividing, faint membranes,
// and noise of light.
Volume cells_volume();

// Returns a head made of analytic shapes as a CT would show it: Hounsfield units as int16 in steps
// of 1.5 mm, 128 x 160 x 160 samples, in a patient's axes (left, posterior, superior), with the
// noise of a scanner.
Volume head_ct();

// Returns the tissue of each voxel of head_ct() as uint8, with names and colours; 0 is none.
Volume head_labels();

inline constexpr std::int64_t jet_times = 10;
inline constexpr double jet_time_step = 0.04;  // s

// Returns the place of the samples of a turbulent jet that rises from a nozzle: 64 x 64 x 128, z
// upwards, in mm.
Grid jet_grid();

// Returns the share of the jet's fluid, from 0 to 255, one time after the other.
std::vector<std::uint8_t> jet_samples();

}  // namespace lamina
