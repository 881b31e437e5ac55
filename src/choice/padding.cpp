// SPDX-License-Identifier: Apache-2.0
#include "choice/padding.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "choice/common_values.h"

namespace lamina {
namespace {

constexpr std::size_t most_values = 4;
// What was measured has more different values than this.
constexpr std::size_t few_values = 24;
constexpr double least_share = 1e-3;

// How far padding is from the rest, in widths of its range. A value above it may as well be a part
// that has one value, a piece of metal in tissue, and so must be farther away.
constexpr double far_below = 1, far_above = 4;
// At this distance the lowest value is padding if the rest has a background of its own, of which
// there is more.
constexpr double near_below = 1.0 / 8;

// Between the rest and the padding colours and extinction end at this part of the way: cells that
// interpolate between the two show little of what lies between them.
constexpr double edge_share = 1.0 / 64;

bool is_padding(double value, double share, const ValueDistribution& rest, bool whole_numbers) {
    // Halves, for differences may overflow.
    const double width = rest.highest() / 2 - rest.lowest() / 2;
    const bool below = value < rest.lowest();
    const double gap = below ? rest.lowest() / 2 - value / 2 : value / 2 - rest.highest() / 2;
    // Where there is nothing, 0 is a value like others.
    if (value != 0 && gap > (below ? far_below : far_above) * width) return true;
    if (!below || !(gap > near_below * width)) return false;
    const CommonValues common = find_common_values(rest, whole_numbers);
    return common.background && share < (1 - share) * rest.share(common.lo, common.hi);
}

}  // namespace

Padding find_padding(const ValueDistribution& all, bool whole_numbers) {
    Padding found;
    found.rest = all;
    const auto take = [&](double value, const ValueDistribution& rest) {
        if (rest.distinct() <= few_values) return false;
        const double share = found.rest.share(value, value);
        if (share < least_share || !is_padding(value, share, rest, whole_numbers)) return false;
        found.values.push_back(value);
        found.share += share * (1 - found.share);
        found.rest = rest;
        return true;
    };
    for (bool more = true; more && found.values.size() < most_values;) {
        const double lowest = found.rest.lowest(), highest = found.rest.highest();
        more = take(lowest, found.rest.between(std::nextafter(lowest, INFINITY), highest)) ||
               take(highest, found.rest.between(lowest, std::nextafter(highest, -INFINITY)));
    }
    if (found.values.empty()) return found;
    const double lo = found.rest.lowest(), hi = found.rest.highest();
    for (const double value : found.values) {
        // The nearest one on each side was found last.
        if (value < lo) found.below = lo - edge_share * std::min(lo - value, hi - lo);
        if (value > hi) found.above = hi + edge_share * std::min(value - hi, hi - lo);
    }
    return found;
}

}  // namespace lamina
