// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "lamina/value_histogram.h"
#include "volume/min_max_bricks.h"

namespace lamina {

struct WeightedValue {
    double value = 0;
    double weight = 0;  // >= 0
};

// The values of a field, each with its share of the field. It depends on the values and their
// weights alone, not on threads.
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

    // Returns the part of the field with values from lo to hi, whose shares add up to 1 again;
    // empty if there is none.
    ValueDistribution between(double lo, double hi) const;

  private:
    std::vector<double> values_;  // ascending, all different
    std::vector<double> up_to_;   // share of all values up to each; the last is 1
};

// The values that most of a field has, from lo to hi: air around a scanned object, the undisturbed
// flow, the vacuum between molecules.
struct CommonValues {
    double lo = 0, hi = 0;
    // True: they stand out as a narrow peak, beyond which values are rare. False: values gather
    // nowhere, and these are just the closest together.
    bool background = false;
};

// Finds the common values of a distribution of two or more values. `whole_numbers`: all values are
// whole.
CommonValues find_common_values(const ValueDistribution& values, bool whole_numbers);

// The range without the outermost thousandth of values at each end, if these take up most of the
// range: a few extreme values would leave no room for all others.
struct UsualRange {
    double lo = 0, hi = 0;
};
UsualRange usual_range(const ValueDistribution& values);

// Counts the values in at most `bins` >= 1 intervals over `range`, which holds them all. Intervals
// of whole numbers hold equally many of them, so that none looks rarer than it is; the first is
// centred so that the lowest is in the middle of its first unit. `values` may be empty.
ValueHistogram binned(const ValueDistribution& values, const ValueRange& range, bool whole_numbers,
                      int bins);

// Values that mean "nothing was measured here", such as -3024 around the round picture of a CT, or
// -9999 on land in a model of the sea.
struct Padding {
    std::vector<double> values;
    double share = 0;                    // of the field
    ValueDistribution rest;              // all other values
    std::optional<double> below, above;  // the padding values next to the rest, if there are any

    // Returns a value between the padding and the rest, close to the rest. Values interpolated
    // between padding and rest are visible only on the rest's side of it.
    double edge_below() const;
    double edge_above() const;
    // Tells whether cells between padding and rest would show the rest's values up to `lo`, or from
    // `hi` on, as a thick shell around the rest.
    bool shell_below(double lo) const;
    bool shell_above(double hi) const;
};

// Share of a volume that a value must have to be padding: fewer samples may be noise.
inline constexpr double least_padding = 1e-3;

// Finds single values that are far from all others, at both ends (docs/first-picture.md).
// `whole_numbers`: all values are whole. `least_share`: a value with less of the field is no
// padding. Values with less than `least_padding` must be farther away than the whole range of the
// rest.
Padding find_padding(const ValueDistribution& all, bool whole_numbers,
                     double least_share = least_padding);

// Returns the values, however rare, that are farther from all others than these are from each
// other, by the distance that padding requires.
std::vector<double> find_markers(const ValueDistribution& all);

}  // namespace lamina
