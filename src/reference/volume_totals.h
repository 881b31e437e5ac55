// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace lamina {

// What the rays of a volume's picture took together.
struct VolumeTotals {
    double error_estimate = 0;  // the largest
    std::int64_t segments = 0;
};

}  // namespace lamina
