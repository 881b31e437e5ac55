// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace lamina {

// These are totals over the rays of a volume's picture.
struct VolumeTotals {
    double error_estimate = 0;  // the largest
    std::int64_t segments = 0;
};

}  // namespace lamina
