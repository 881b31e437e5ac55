// SPDX-License-Identifier: Apache-2.0
#include "choice/value_distribution.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <tuple>

#include "base/parallel.h"

namespace lamina {

// Equal values are sorted by weight, so that sums do not depend on the order of the input.
ValueDistribution::ValueDistribution(std::vector<WeightedValue> values) {
    std::erase_if(values, [](const WeightedValue& one) { return !(one.weight > 0); });
    parallel_sort(values.begin(), values.end(), [](const WeightedValue& a, const WeightedValue& b) {
        return std::tie(a.value, a.weight) < std::tie(b.value, b.weight);
    });
    double sum = 0;
    for (const WeightedValue& one : values) {
        sum += one.weight;
        if (values_.empty() || values_.back() != one.value) {
            values_.push_back(one.value);
            up_to_.push_back(sum);
        } else {
            up_to_.back() = sum;
        }
    }
    for (double& share : up_to_) share /= sum;
}

double ValueDistribution::share_up_to(double value) const {
    const auto above = std::ranges::upper_bound(values_, value);
    return above == values_.begin() ? 0
                                    : up_to_[static_cast<std::size_t>(above - values_.begin()) - 1];
}

double ValueDistribution::share_below(double value) const {
    const auto at = std::ranges::lower_bound(values_, value);
    return at == values_.begin() ? 0 : up_to_[static_cast<std::size_t>(at - values_.begin()) - 1];
}

double ValueDistribution::quantile(double share) const {
    const auto at = std::ranges::lower_bound(up_to_, share);
    return at == up_to_.end() ? values_.back()
                              : values_[static_cast<std::size_t>(at - up_to_.begin())];
}

ValueDistribution ValueDistribution::between(double lo, double hi) const {
    const auto first = std::ranges::lower_bound(values_, lo) - values_.begin();
    const auto end = std::ranges::upper_bound(values_, hi) - values_.begin();
    ValueDistribution part;
    if (first >= end) return part;
    const double before = first > 0 ? up_to_[static_cast<std::size_t>(first) - 1] : 0;
    const double all = up_to_[static_cast<std::size_t>(end) - 1] - before;
    for (auto i = static_cast<std::size_t>(first); i < static_cast<std::size_t>(end); ++i) {
        part.values_.push_back(values_[i]);
        part.up_to_.push_back((up_to_[i] - before) / all);
    }
    part.up_to_.back() = 1;
    return part;
}

namespace {

constexpr int most_bins = 256;        // number of bins, and of intervals that densest() tries
constexpr double outer_share = 1e-3;  // share of values that usual_range() leaves out at each end
// They are left out if the other values take less than this share of the range.
constexpr double outer_width = 1.0 / 8;

// A peak ends if the mean density over the next 1 / tail_width of the range is below `tail` times
// the density at the peak. Noise and blur around a peak are less dense, scanned objects denser.
constexpr double tail = .03;
constexpr int tail_width = 20;

// Background fills at least this share of the field, in at most this share of its range.
constexpr double least_share = .2, most_width = .4;
constexpr double common_share = 1.0 / 3;  // of the field, if there is no background

// The distribution over usual_range() in equal bins; the outermost hold all values beyond.
class Bins {
  public:
    Bins(const ValueDistribution& values, bool whole_numbers) {
        const ValueRange range = usual_range(values);
        lo_ = range.lo;
        width_ = (range.hi - range.lo) / most_bins;
        // For whole numbers, every bin holds equally many numbers.
        if (whole_numbers) width_ = std::ceil(width_);
        const auto count =
            static_cast<std::size_t>(std::lround((range.hi - range.lo) / width_)) + 1;
        for (std::size_t i = 0; i < count; ++i)
            shares_.push_back(values.share_below(edge(i + 1)) - values.share_below(edge(i)));
        shares_.front() += values.share_below(edge(0));
        shares_.back() += 1 - values.share_below(edge(count));
    }

    std::size_t highest() const {
        return static_cast<std::size_t>(std::ranges::max_element(shares_) - shares_.begin());
    }

    // Returns the last bin of the peak, going upwards (step 1) or downwards (-1).
    std::size_t end_of_peak(std::size_t peak, int step) const {
        const auto window =
            static_cast<std::ptrdiff_t>(std::max<std::size_t>(shares_.size() / tail_width, 1));
        const auto count = static_cast<std::ptrdiff_t>(shares_.size());
        const double limit = tail * shares_[peak];
        auto last = static_cast<std::ptrdiff_t>(peak);
        for (;; last += step) {
            double sum = 0;
            std::ptrdiff_t found = 0;
            for (std::ptrdiff_t i = last + step; found < window && i >= 0 && i < count; i += step) {
                sum += shares_[static_cast<std::size_t>(i)];
                ++found;
            }
            if (found == 0 || sum < limit * static_cast<double>(found))
                return static_cast<std::size_t>(last);
        }
    }

    double edge(std::size_t bin) const { return lo_ + (static_cast<double>(bin) - .5) * width_; }
    std::size_t count() const { return shares_.size(); }

  private:
    double lo_ = 0, width_ = 1;
    std::vector<double> shares_;
};

// Returns the shortest interval that holds this share of the values.
CommonValues densest(const ValueDistribution& values, double share) {
    CommonValues best{values.lowest(), values.highest(), false};
    for (int i = 0; i < most_bins; ++i) {
        const double below = (1 - share) * i / most_bins;
        const double lo = values.quantile(below), hi = values.quantile(below + share);
        if (hi - lo < best.hi - best.lo) best = {lo, hi, false};
    }
    return best;
}

constexpr std::size_t most_values = 4;  // largest number of padding values
// Number of different values that the rest must exceed: fewer are labels.
constexpr std::size_t few_values = 24;

// Least distance of padding below or above the rest, in widths of the rest's range: larger above,
// because a high value may be a real object, such as metal in tissue.
constexpr double far_below = 1, far_above = 4;
// Least distance of the lowest value if the rest has a background more frequent than it.
constexpr double near_below = 1.0 / 8;

// Distance of Padding::edge_...() from the rest: share of the gap or of the rest's range.
constexpr double edge_share = 1.0 / 64;
constexpr double thin_shell = 1.0 / 50;  // share of a voxel up to which a shell is thin

// Half the distance of a value to the rest, and half the rest's width: the whole may overflow.
struct HalfDistance {
    double gap, width;
    bool below;

    HalfDistance(double value, const ValueDistribution& rest)
        : gap(value < rest.lowest() ? rest.lowest() / 2 - value / 2
                                    : value / 2 - rest.highest() / 2),
          width(rest.highest() / 2 - rest.lowest() / 2),
          below(value < rest.lowest()) {}
};

// Tells whether a value is so far from the rest that it is padding however rare it is.
bool is_marker(double value, const ValueDistribution& rest) {
    const HalfDistance found(value, rest);
    // 0 does not mark missing data: it is the natural value of empty space.
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

// Takes values from both ends as padding as long as `is_one(value, share, rest)` holds.
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
    // Tells whether a value at one end may be padding by its distance from the next; if not, the
    // rest need not be copied.
    const auto apart = [&](std::size_t value, std::size_t next, std::size_t other_end) {
        const auto half = [&](std::size_t number) { return found.rest.value(number) / 2; };
        return std::abs(half(value) - half(next)) >
               near_below * std::abs(half(next) - half(other_end));
    };
    for (bool more = true; more && found.values.size() < most_values;) {
        const std::size_t last = found.rest.distinct() - 1;
        if (last <= few_values) break;
        const double lowest = found.rest.lowest(), highest = found.rest.highest();
        more = (apart(0, 1, last) &&
                take(lowest, found.rest.between(std::nextafter(lowest, INFINITY), highest))) ||
               (apart(last, last - 1, 0) &&
                take(highest, found.rest.between(lowest, std::nextafter(highest, -INFINITY))));
    }
    return found;
}

}  // namespace

ValueRange usual_range(const ValueDistribution& values) {
    const ValueRange all{values.lowest(), values.highest()};
    const ValueRange inner{values.quantile(outer_share), values.quantile(1 - outer_share)};
    const bool outliers =
        inner.lo < inner.hi && inner.hi - inner.lo < outer_width * (all.hi - all.lo);
    return outliers ? inner : all;
}

// Takes the fullest bin of a histogram as the peak and extends it to both sides (end_of_peak()). If
// the peak is narrow and holds enough of the values, it is background. Otherwise the shortest
// interval with a third of the values is taken.
CommonValues find_common_values(const ValueDistribution& values, bool whole_numbers) {
    // Data of two values are a mask, in which the more frequent value is background.
    if (values.distinct() == 2) {
        const bool low = values.share_up_to(values.lowest()) >= 0.5;
        const double more = low ? values.lowest() : values.highest();
        return {more, more, true};
    }
    // A range too narrow to be divided in double precision has no bins.
    const ValueRange range = usual_range(values);
    const double width = range.hi - range.lo;
    if (!(width / most_bins > 0) || !std::isfinite(width)) return densest(values, common_share);
    const Bins bins(values, whole_numbers);
    const std::size_t peak = bins.highest();
    const std::size_t first = bins.end_of_peak(peak, -1), last = bins.end_of_peak(peak, 1);
    CommonValues found{bins.edge(first), bins.edge(last + 1), true};
    if (first == 0) found.lo = values.lowest();
    if (last + 1 == bins.count()) found.hi = values.highest();
    const double share = static_cast<double>(last - first + 1) / static_cast<double>(bins.count());
    const bool background = share <= most_width && values.share(found.lo, found.hi) >= least_share;
    return background ? found : densest(values, common_share);
}

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
    // A value on an edge counts for the interval above; the last interval holds both its edges.
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
        // `values` go inwards, so the last one on each side is the nearest to the rest.
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
