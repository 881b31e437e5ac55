// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace lamina {

// How much of the data has which values, by volume: shares[i] of all that is finite lies in
// interval i of equally wide ones from `lo` to `hi`.
struct ValueHistogram {
    double lo = 0, hi = 0;
    double least = 0, most = 0;  // the finite values' range
    std::vector<double> shares;  // >= 0, the sum is 1; empty where no value is finite
};

}  // namespace lamina
