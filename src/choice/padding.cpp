// SPDX-License-Identifier: Apache-2.0
#include "choice/padding.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "choice/common_values.h"

namespace lamina {
namespace {

constexpr std::size_t most_values = 4;
// Measured data have more different values than this.
constexpr std::size_t few_values = 24;
constexpr double least_padding = 1e-3;

// How far padding is from the rest, in widths of its range. A value above it may as well be a part
// that has one value, a piece of metal in tissue, and so must be farther away.
constexpr double far_below = 1, far_above = 4;
// At this distance the lowest value is padding if the rest has a background of its own, of which
// there is more.
constexpr double near_below = 1.0 / 8;

constexpr double edge_share = 1.0 / 64;  // of the way to the padding, or of the rest's range
constexpr double thin_shell = 1.0 / 50;  // of a voxel

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
    if (all.empty()) return found;
    const auto take = [&](double value, const ValueDistribution& rest) {
        if (rest.distinct() <= few_values) return false;
        const double share = found.rest.share(value, value);
        if (share < least_padding || !is_padding(value, share, rest, whole_numbers)) return false;
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
    for (const double value : found.values) {
        // The nearest one on each side was found last.
        if (value < found.rest.lowest()) found.below = value;
        if (value > found.rest.highest()) found.above = value;
    }
    return found;
}

double Padding::edge_below() const {
    const double lo = rest.lowest();
    return lo - edge_share * std::min(lo - *below, rest.highest() - lo);
}

double Padding::edge_above() const {
    const double hi = rest.highest();
    return hi + edge_share * std::min(*above - hi, hi - rest.lowest());
}

bool Padding::shell_below(double lo) const {
    return below && lo - rest.lowest() > thin_shell * (lo - *below);
}

bool Padding::shell_above(double hi) const {
    return above && rest.highest() - hi > thin_shell * (*above - hi);
}

}  // namespace lamina
