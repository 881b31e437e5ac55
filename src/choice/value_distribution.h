// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "lamina/report.h"
#include "volume/min_max_bricks.h"

namespace lamina {

struct WeightedValue {
    double value = 0;
    double weight = 0;  // >= 0
};

// The values of a field, each with its share of it, whatever the threads.
class ValueDistribution {
  public:
    ValueDistribution() = default;  // an empty distribution
    // Takes finite values in any order; those without weight are dropped.
    explicit ValueDistribution(std::vector<WeightedValue> values);

    bool empty() const { return values_.empty(); }
    std::size_t distinct() const { return values_.size(); }
    double value(std::size_t number) const { return values_[number]; }  // ascending
    double lowest() const { return values_.front(); }
    double highest() const { return values_.back(); }

    // Return the share, 0..1, of the field whose values are at most, or less than, `value`.
    double share_up_to(double value) const;
    double share_below(double value) const;
    double share(double lo, double hi) const { return share_up_to(hi) - share_below(lo); }
    // Returns the least value up to which at least this share lies.
    double quantile(double share) const;

    // Returns the part with values from lo to hi, whose shares add up to 1; may be empty.
    ValueDistribution between(double lo, double hi) const;

  private:
    std::vector<double> values_;  // ascending, all different
    std::vector<double> up_to_;   // share of all values up to each; the last is 1
};

// The values that most of a field has, from lo to hi: air around an object, undisturbed flow.
struct CommonValues {
    double lo = 0, hi = 0;
    // True: a narrow peak, beyond which values are rare. False: just the values closest together.
    bool background = false;
};

// Finds the common values of two or more. `whole_numbers`: all values are whole.
CommonValues find_common_values(const ValueDistribution& values, bool whole_numbers);

// Returns the range without the outermost thousandth of values at each end, if these take up most
// of the range: a few extreme values would leave no room for all others.
ValueRange usual_range(const ValueDistribution& values);

// Counts the values, if any, in at most `bins` >= 1 intervals over `range`, which holds all. Those
// of whole numbers hold equally many, the lowest in the middle of its own unit.
ValueHistogram binned(const ValueDistribution& values, const ValueRange& range, bool whole_numbers,
                      int bins);

// Values that mean "nothing was measured here": -3024 around a round CT, -9999 on land in a sea.
struct Padding {
    std::vector<double> values;
    double share = 0;                    // of the field
    ValueDistribution rest;              // all other values
    std::optional<double> below, above;  // the padding values next to the rest, if there are any

    // Returns a value between padding and rest, from which on interpolated values show.
    double edge_below() const;
    double edge_above() const;
    // Tells whether values up to `lo`, or from `hi` on, would be a thick shell towards the padding.
    bool shell_below(double lo) const;
    bool shell_above(double hi) const;
};

// Share of a volume that a value must have to be padding: fewer samples may be noise.
inline constexpr double least_padding = 1e-3;

// Finds single values far from all others, at both ends (docs/first-picture.md). Those with less
// than `least_share` are none; with less than `least_padding` they must be a whole range away.
Padding find_padding(const ValueDistribution& all, bool whole_numbers,
                     double least_share = least_padding);

// Returns the values, however rare, that lie as far from all others as padding must.
std::vector<double> find_markers(const ValueDistribution& all);

}  // namespace lamina
