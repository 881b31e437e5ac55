// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

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

}  // namespace lamina
