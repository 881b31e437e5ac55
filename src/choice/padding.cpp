// SPDX-License-Identifier: Apache-2.0
#include "choice/padding.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "choice/common_values.h"

namespace lamina {
namespace {

constexpr std::size_t most_values = 4;
// Number of different values that measured data exceed.
constexpr std::size_t few_values = 24;

// Least distance of padding from the rest, in widths of the rest's range. It is larger above: a
// high value may be a real object of a single value, such as metal in tissue.
constexpr double far_below = 1, far_above = 4;
// Least distance of the lowest value to be padding if the rest has a background of its own that is
// more frequent.
constexpr double near_below = 1.0 / 8;

constexpr double edge_share = 1.0 / 64;  // share of the way to the padding, or of the range
constexpr double thin_shell = 1.0 / 50;  // as a share of a voxel

// Differences of halved values, because those of the values themselves may overflow.
struct HalfDistance {
    double gap, width;  // distance to the rest, and its range
    bool below;

    HalfDistance(double value, const ValueDistribution& rest)
        : gap(value < rest.lowest() ? rest.lowest() / 2 - value / 2
                                    : value / 2 - rest.highest() / 2),
          width(rest.highest() / 2 - rest.lowest() / 2),
          below(value < rest.lowest()) {}
};

bool is_marker(double value, const ValueDistribution& rest) {
    const HalfDistance found(value, rest);
    // 0 is never a marker: it is the natural value of empty space.
    return value != 0 && found.gap > (found.below ? far_below : far_above) * found.width;
}

bool is_padding(double value, double share, const ValueDistribution& rest, bool whole_numbers) {
    if (is_marker(value, rest)) return true;
    const HalfDistance found(value, rest);
    if (share < least_padding || !found.below || !(found.gap > near_below * found.width))
        return false;
    const CommonValues common = find_common_values(rest, whole_numbers);
    return common.background && share < (1 - share) * rest.share(common.lo, common.hi);
}

// Removes values from both ends as long as `is_one(value, share, rest)` holds.
template <typename IsOne>
Padding take_from_ends(const ValueDistribution& all, const IsOne& is_one) {
    Padding found;
    found.rest = all;
    if (all.empty()) return found;
    const auto take = [&](double value, const ValueDistribution& rest) {
        if (rest.distinct() <= few_values) return false;
        const double share = found.rest.share(value, value);
        if (!is_one(value, share, rest)) return false;
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
    return found;
}

}  // namespace

std::vector<double> find_markers(const ValueDistribution& all) {
    return take_from_ends(all, [](double value, double,
                                  const ValueDistribution& rest) { return is_marker(value, rest); })
        .values;
}

Padding find_padding(const ValueDistribution& all, bool whole_numbers, double least_share) {
    Padding found =
        take_from_ends(all, [&](double value, double share, const ValueDistribution& rest) {
            return share >= least_share && is_padding(value, share, rest, whole_numbers);
        });
    for (const double value : found.values) {
        // The last value found on each side is the nearest to the rest.
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
