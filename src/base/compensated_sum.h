// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace lamina {

// A sum of many numbers. Its rounding error does not grow with their count (Neumaier 1974).
class CompensatedSum {
  public:
    void add(double term) {
        const double sum = sum_ + term;
        rest_ += std::abs(sum_) >= std::abs(term) ? (sum_ - sum) + term : (term - sum) + sum_;
        sum_ = sum;
    }
    double value() const { return sum_ + rest_; }

  private:
    double sum_ = 0;
    double rest_ = 0;
};

}  // namespace lamina
