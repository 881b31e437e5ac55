// SPDX-License-Identifier: Apache-2.0
#include "choice/common_values.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace lamina {
namespace {

constexpr int most_bins = 256;
constexpr double outer_share = 1e-3;     // share of the values cut off at each end
constexpr double outer_width = 1.0 / 8;  // largest share of the range left to cut them

// A peak ends where the density of the next twentieth of the range falls below this share of the
// peak's. Tails of noise and blur lie below, scanned objects above.
constexpr double tail = .03;
constexpr int tail_width = 20;

// Background takes at least a fifth of the field, in at most two fifths of its range.
constexpr double least_share = .2, most_width = .4;
// Share of the field that counts as common if nothing stands out.
constexpr double common_share = 1.0 / 3;

class Bins {
  public:
    Bins(const ValueDistribution& values, bool whole_numbers) {
        const UsualRange range = usual_range(values);
        lo_ = range.lo;
        width_ = (range.hi - range.lo) / most_bins;
        // Bins of whole numbers all hold equally many.
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

    // Returns the last bin that belongs to the peak, upwards (step 1) or downwards (-1).
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

// Returns the shortest interval with that share.
CommonValues densest(const ValueDistribution& values, double share) {
    CommonValues best{values.lowest(), values.highest(), false};
    for (int i = 0; i < most_bins; ++i) {
        const double below = (1 - share) * i / most_bins;
        const double lo = values.quantile(below), hi = values.quantile(below + share);
        if (hi - lo < best.hi - best.lo) best = {lo, hi, false};
    }
    return best;
}

}  // namespace

UsualRange usual_range(const ValueDistribution& values) {
    const UsualRange all{values.lowest(), values.highest()};
    const UsualRange inner{values.quantile(outer_share), values.quantile(1 - outer_share)};
    const bool outliers =
        inner.lo < inner.hi && inner.hi - inner.lo < outer_width * (all.hi - all.lo);
    return outliers ? inner : all;
}

CommonValues find_common_values(const ValueDistribution& values, bool whole_numbers) {
    // Two values are a mask: the more frequent one is background.
    if (values.distinct() == 2) {
        const bool low = values.share_up_to(values.lowest()) >= 0.5;
        const double more = low ? values.lowest() : values.highest();
        return {more, more, true};
    }
    // A range too narrow to be divided in double precision has no bins.
    const UsualRange range = usual_range(values);
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

}  // namespace lamina
