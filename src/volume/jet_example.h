// SPDX-License-Identifier: Apache-2.0
// A turbulent jet that rises from a nozzle: a series of times.
#pragma once

#include <cstdint>
#include <vector>

#include "lamina/volume.h"

namespace lamina {

inline constexpr std::int64_t jet_times = 10;
inline constexpr double jet_time_step = 0.04;  // s

// Returns the place of the jet's samples: 64 x 64 x 128, z upwards, in mm.
Grid jet_grid();

// Returns the share of the jet's fluid, from 0 to 255, one time after the other. Parallel, with
// progress.
std::vector<std::uint8_t> jet_samples();

}  // namespace lamina
