// SPDX-License-Identifier: Apache-2.0
#include "choice/materials.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>

namespace lamina {

namespace {

// A hump stands out if it is this many times as high as the lowest place between it and a higher
// one. Less is the ripple of a smooth histogram: MRI's white matter stands out 1.5 times.
constexpr double least_prominence = 1.25;
constexpr double least_hump = .01;        // of the field, for a hump
constexpr double least_excess = .003;     // of the field, of a hump above the valley below it
constexpr double least_background = .2;   // of the field
constexpr double most_clipped = .05;      // of the field, for values cut off at an end
constexpr double clipped_peak = 3;        // times as many as in the bin beside them
constexpr double surface_coherence = .5;  // least share of coherent places on a surface
constexpr double homogeneous_slope = .6;  // largest slope of a hump, relative to its surfaces
constexpr double flat_slope = .85;  // largest slope of any hump, relative to its surface below
// Largest mean change to a neighbour, relative to the distance of two humps, of things with sharp
// edges. If neighbours were of either hump by chance, half a difference along three axes would
// be .6 of it.
constexpr double most_change = .3;
constexpr double foot = .1;              // share of its height at which the last hump ends
constexpr double least_rest = .005;      // of the field, for what lies beyond the last hump
constexpr double least_rest_width = .1;  // of the range, likewise
constexpr double steep = .8;             // share of the largest slope that makes its surface
constexpr double rare_rest = .05;        // share of the rest that is left out, as too rare

using Shares = std::vector<double>;

// Returns the shares with values that were cut off at the upper end, like 255 in a picture that is
// too bright, lowered to their neighbours: they are no material of their own.
Shares without_clipped(Shares shares) {
    const std::size_t n = shares.size();
    if (n < 8) return shares;
    const double usual = shares[n - 3], clipped = shares[n - 2] + shares[n - 1];
    if (clipped < most_clipped && clipped > clipped_peak * usual)
        shares[n - 2] = shares[n - 1] = usual;
    return shares;
}

// Returns the mean over each bin and two on both sides; ends repeat.
Shares smoothed(const Shares& shares) {
    const auto n = static_cast<std::ptrdiff_t>(shares.size());
    Shares result(shares.size());
    for (std::ptrdiff_t i = 0; i < n; ++i) {
        for (std::ptrdiff_t j = i - 2; j <= i + 2; ++j)
            result[static_cast<std::size_t>(i)] +=
                shares[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(j, 0, n - 1))] / 5;
    }
    return result;
}

// Returns the tops of humps that stand out, ascending. Bins are taken from the highest on; each
// joins the hump beside it, and where two humps meet, the lower one ends.
std::vector<std::size_t> prominent(const Shares& heights) {
    const std::size_t n = heights.size(), none = n;
    std::vector<std::size_t> order(n), top(n, none);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, std::greater<>(), [&](std::size_t i) { return heights[i]; });
    const auto top_of = [&](std::size_t i) {
        while (top[i] != i) i = top[i];
        return i;
    };
    std::vector<std::size_t> found{order.front()};
    for (const std::size_t bin : order) {
        if (!(heights[bin] > 0)) break;
        const std::size_t below = bin > 0 && top[bin - 1] != none ? top_of(bin - 1) : none;
        const std::size_t above = bin + 1 < n && top[bin + 1] != none ? top_of(bin + 1) : none;
        top[bin] = below != none ? below : above != none ? above : bin;
        if (below == none || above == none) continue;
        const std::size_t lower = heights[below] < heights[above] ? below : above;
        if (heights[lower] > least_prominence * heights[bin]) found.push_back(lower);
        top[lower] = lower == below ? above : below;
        top[bin] = top[lower];
    }
    // Humps apart from all others, with empty bins between, were not met.
    for (std::size_t i = 0; i < n; ++i) {
        if (top[i] == i && std::ranges::find(found, i) == found.end()) found.push_back(i);
    }
    std::ranges::sort(found);
    return found;
}

// Humps of a histogram, from which those are taken away that are no materials.
class Humps {
  public:
    Humps(const ValueHistogram& histogram, const Variation& variation, double spacing)
        : shares_(without_clipped(histogram.shares)),
          variation_(variation),
          spacing_(spacing),
          heights_(smoothed(smoothed(shares_))),
          tops_(prominent(heights_)) {
        while (tops_.size() > 1 && take_away_rare()) {
        }
        while (tops_.size() > 1 && take_away_noise()) {
        }
        while (tops_.size() > 1 && take_away_ripple()) {
        }
        while (tops_.size() > 1 && take_away_unbounded()) {
        }
        while (tops_.size() > most_materials && take_away_rarest()) {
        }
    }

    Materials materials() const {
        Materials found{variation_.value(tops_.front()), {}};
        if (tops_.size() < 2 || share(0) < least_background) return found;
        for (std::size_t i = 1; i < tops_.size(); ++i) {
            found.materials.push_back(
                {variation_.value(boundary(i)), variation_.value(tops_[i]), share(i)});
        }
        if (found.materials.size() < most_materials) add_rest(found.materials);
        return found;
    }

  private:
    // Returns the lowest bin between hump i - 1 and hump i; the first begins at 0, the last ends
    // behind all bins.
    std::size_t begin(std::size_t i) const {
        if (i == 0) return 0;
        if (i == tops_.size()) return heights_.size();
        const auto at = [&](std::size_t bin) {
            return heights_.begin() + static_cast<std::ptrdiff_t>(bin);
        };
        return static_cast<std::size_t>(std::min_element(at(tops_[i - 1]), at(tops_[i] + 1)) -
                                        heights_.begin());
    }

    double share_of_bins(std::size_t first, std::size_t end) const {
        double sum = 0;
        for (std::size_t i = first; i < end; ++i) sum += shares_[i];
        return sum;
    }
    double share(std::size_t i) const { return share_of_bins(begin(i), begin(i + 1)); }

    // Tells if no value lies between hump i - 1 and hump i, and their places lie together: then
    // they are things with sharp edges, whatever the noise in them. A single value has no noise: it
    // may be padding.
    bool apart(std::size_t i) const {
        const std::size_t from = tops_[i - 1], to = tops_[i];
        if (shares_[from > 0 ? from - 1 : from + 1] == 0 && shares_[from + 1] == 0) return false;
        const double change = std::max(variation_.slope(from), variation_.slope(to)) * spacing_;
        return heights_[begin(i)] == 0 &&
               change < most_change * (variation_.value(to) - variation_.value(from));
    }

    // Returns the bin of the steepest value between hump i - 1 and hump i, in the middle half; not
    // among the values of noise.
    std::size_t boundary(std::size_t i) const {
        if (apart(i)) return std::midpoint(tops_[i - 1], tops_[i]);
        const std::size_t from = tops_[i - 1], to = tops_[i], quarter = (to - from) / 4;
        const std::size_t last = std::max(to - quarter, from + quarter);
        std::size_t first = std::min(std::max(from + quarter, noise_end_), to - 1),
                    steepest = first;
        for (std::size_t bin = first; bin <= last; ++bin)
            if (variation_.slope(bin) > variation_.slope(steepest)) steepest = bin;
        return steepest;
    }

    void erase(std::size_t i) { tops_.erase(tops_.begin() + static_cast<std::ptrdiff_t>(i)); }

    std::size_t rarest() const {
        std::size_t found = 0;
        for (std::size_t i = 1; i < tops_.size(); ++i)
            if (share(i) < share(found)) found = i;
        return found;
    }

    bool take_away_rarest() {
        erase(rarest());
        return true;
    }
    bool take_away_rare() {
        if (share(rarest()) < least_hump) return take_away_rarest();
        for (std::size_t i = 1; i < tops_.size(); ++i) {
            if (share_above_valley(i) >= least_excess) continue;
            erase(i);
            return true;
        }
        return false;
    }

    // Returns how much of the field makes hump i rise above the valley below it.
    double share_above_valley(std::size_t i) const {
        const double valley = heights_[begin(i)];
        double sum = 0;
        for (std::size_t bin = begin(i); bin < begin(i + 1); ++bin)
            sum += std::max(heights_[bin] - valley, 0.);
        return sum;
    }

    // Takes away a hump next to the background whose places are neither coherent nor flatter than
    // their surroundings: the noise around an object.
    bool take_away_noise() {
        const std::size_t top = tops_[1];
        if (variation_.coherence(top) >= surface_coherence || apart(1)) return false;
        double steepest = 0;
        const std::size_t end = tops_.size() > 2 ? tops_[2] : heights_.size();
        for (std::size_t bin = tops_[0]; bin < end; ++bin)
            if (heights_[bin] > 0) steepest = std::max(steepest, variation_.slope(bin));
        const double beside = std::min(steepest, steepest_between(tops_[0], top));
        if (variation_.slope(top) < homogeneous_slope * beside) return false;
        noise_end_ = std::max(noise_end_, begin(2) == heights_.size() ? top : begin(2));
        erase(1);
        return true;
    }

    double steepest_between(std::size_t first, std::size_t last) const {
        double found = 0;
        for (std::size_t bin = first; bin <= last; ++bin)
            found = std::max(found, variation_.slope(bin));
        return found;
    }

    // Takes away a hump that is no flatter than what lies between it and the hump below: in a
    // smooth field a value is frequent without being that of a thing.
    bool take_away_ripple() {
        for (std::size_t i = 1; i < tops_.size(); ++i) {
            const double beside = steepest_between(tops_[i - 1], tops_[i]);
            if (variation_.slope(tops_[i]) < flat_slope * beside || apart(i)) continue;
            erase(i);
            return true;
        }
        return false;
    }

    // Takes away one of two humps without a surface between them: the rarer one.
    bool take_away_unbounded() {
        for (std::size_t i = 1; i < tops_.size(); ++i) {
            if (apart(i) || variation_.coherence(boundary(i)) >= surface_coherence) continue;
            erase(share(i - 1) < share(i) && i > 1 ? i - 1 : i == 1 && share(0) < share(1) ? 0 : i);
            return true;
        }
        return false;
    }

    // Adds what lies beyond the last hump, such as bone beyond soft tissue, if it has a surface.
    void add_rest(std::vector<Material>& materials) const {
        const std::size_t n = heights_.size();
        std::size_t end = tops_.back();
        while (end < n && heights_[end] > foot * heights_[tops_.back()]) ++end;
        const double rest = share_of_bins(end, n);
        if (rest < least_rest || static_cast<double>(n - end) < least_rest_width * double(n))
            return;
        double steepest = 0, left = rest;
        for (std::size_t bin = end; bin < n && left > rare_rest * rest; ++bin) {
            steepest = std::max(steepest, variation_.slope(bin));
            left -= shares_[bin];
        }
        std::size_t surface = end;
        while (surface + 1 < n && variation_.slope(surface) < steep * steepest) ++surface;
        if (variation_.coherence(surface) < surface_coherence) return;
        materials.push_back(
            {variation_.value(surface), variation_.value(surface + (n - surface) / 2), rest});
    }

    Shares shares_;
    const Variation& variation_;
    const double spacing_;
    Shares heights_;
    std::vector<std::size_t> tops_;
    std::size_t noise_end_ = 0;  // first bin beyond humps that were noise
};

}  // namespace

Materials find_materials(const ValueHistogram& histogram, const Variation& variation,
                         double spacing) {
    if (histogram.shares.size() < 8 || variation.empty()) return {};
    return Humps(histogram, variation, spacing).materials();
}

}  // namespace lamina
