// SPDX-License-Identifier: Apache-2.0
#include "choice/value_distribution.h"

#include <algorithm>
#include <cstddef>
#include <tuple>

#include "base/parallel.h"

namespace lamina {

// Weights of equal values are added in ascending order, so that the sum does not depend on the
// order of the input.
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

}  // namespace lamina
