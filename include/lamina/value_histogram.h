// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace lamina {

// Distribution of the data's values, by volume: the share shares[i] of all finite values lies in
// interval i. The intervals are equally wide and reach from `lo` to `hi`.
struct ValueHistogram {
    double lo = 0, hi = 0;
    double least = 0, most = 0;  // the finite values' range
    std::vector<double> shares;  // >= 0, their sum is 1; empty if no value is finite
};

}  // namespace lamina
