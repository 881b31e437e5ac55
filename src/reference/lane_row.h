// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "simd/lane_set.h"

namespace lamina {

// A number for each lane of a packet of rays.
struct alignas(64) LaneRow : std::array<double, longest_vector> {};

}  // namespace lamina
