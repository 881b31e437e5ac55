// SPDX-License-Identifier: Apache-2.0
#include "choice/binned_values.h"

#include <cmath>
#include <cstddef>

namespace lamina {

ValueHistogram binned(const ValueDistribution& values, const ValueRange& range, bool whole_numbers,
                      int bins) {
    ValueHistogram histogram;
    if (values.empty()) return histogram;
    histogram.lo = histogram.least = range.lo;
    histogram.hi = histogram.most = range.hi;
    double count = range.lo < range.hi ? bins : 1;
    if (whole_numbers) {
        const double numbers = range.hi - range.lo + 1;
        const double width = std::ceil(numbers / bins);
        count = std::ceil(numbers / width);
        histogram.lo = range.lo - .5;
        histogram.hi = histogram.lo + count * width;
    }
    // A value on the edge of two intervals counts for the upper one; the last interval holds both
    // of its edges.
    double before = 0;
    for (double i = 1; i < count; ++i) {
        const double share = i / count;
        // This form does not overflow even if hi - lo does.
        const double below = values.share_below((1 - share) * histogram.lo + share * histogram.hi);
        histogram.shares.push_back(below - before);
        before = below;
    }
    histogram.shares.push_back(1 - before);
    return histogram;
}

}  // namespace lamina
