// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "lamina/report.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// A value and how often it occurs, in any unit.
struct WeightedValue {
    double value = 0;
    double weight = 0;  // >= 0
};

// The values of a field, each with its share. The result does not depend on the number of threads.
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

    // Returns the distribution of the values from lo to hi, whose shares add up to 1; may be empty.
    ValueDistribution between(double lo, double hi) const;

  private:
    std::vector<double> values_;  // ascending, all different
    std::vector<double> up_to_;   // share of all values up to each; the last is 1
};

// The values that most of a field has, from lo to hi: air around an object, undisturbed flow.
struct CommonValues {
    double lo = 0, hi = 0;
    // True: they are a narrow peak. False: they are the third of all values closest together.
    bool background = false;
};

// Finds the common values of two or more values. `whole_numbers`: all are whole.
CommonValues find_common_values(const ValueDistribution& values, bool whole_numbers);

// Returns the range of the values. If the outermost thousandths at both ends take up more than 7/8
// of the range, they are left out, because the other values would share too few bins.
ValueRange usual_range(const ValueDistribution& values);

// Counts the values in at most `bins` >= 1 intervals over `range`, which holds them all; empty if
// there are none. For whole numbers, all hold equally many and begin half a unit below the least.
ValueHistogram binned(const ValueDistribution& values, const ValueRange& range, bool whole_numbers,
                      int bins);

// Values that mean "nothing was measured here": -3024 around a round CT, -9999 on land in a sea.
struct Padding {
    std::vector<double> values;
    double share = 0;        // of the field
    ValueDistribution rest;  // all other values
    // The padding values nearest to the rest on each side, if any.
    std::optional<double> below, above;

    // Return a value between padding and rest, from which on interpolated values may show.
    double edge_below() const;
    double edge_above() const;
    // Tell whether values up to `lo`, or from `hi` on, would show as a thick shell at padding.
    bool shell_below(double lo) const;
    bool shell_above(double hi) const;
};

// Share of a volume from which on a value may be padding: fewer samples may be noise.
inline constexpr double least_padding = 1e-3;

// Finds padding: single values far from all others, at both ends (docs/first-picture.md). Values
// with a share below `least_share` are no padding; values with a share below `least_padding` must
// be at least as far away as the range of all other values is wide.
Padding find_padding(const ValueDistribution& all, bool whole_numbers,
                     double least_share = least_padding);

// Returns the values, however rare, that lie so far from all others that they mark missing data.
std::vector<double> find_markers(const ValueDistribution& all);

}  // namespace lamina
