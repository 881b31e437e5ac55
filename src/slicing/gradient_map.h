// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "lamina/volume.h"
#include "plan/plan.h"

namespace lamina {

// The gradients at the samples of a brick (docs/numerics.md, section 10), along the grid's axes,
// which are orthogonal: lights are turned into them. Four half-precision numbers a sample, x
// lowest, the last one 0, in the order of the brick's samples.
struct GradientMap {
    // One unit of the numbers is 1 / scale scalar units per world unit; a power of two.
    double scale = 1;
    std::vector<std::uint64_t> gradients;
};

// `range`: of the volume's finite values.
GradientMap make_gradient_map(const Volume& volume, const ValueRange& range,
                              const TextureBrick& part);

}  // namespace lamina
