// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "lamina/volume.h"
#include "volume/code_counts.h"

namespace lamina {

// Which values a volume has.
struct ValueCounts {
    Counts codes;             // of integers: how many samples have each value, from the lowest on
    std::vector<float> some;  // of floats: every sample_step()-th sample, if it is finite
};

// The step has no factor in common with the length of a row, so that all columns take part.
std::int64_t sample_step(const Grid& grid);

ValueCounts count_values(const Volume& volume);  // in memory

}  // namespace lamina
