// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

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

// A number of 31 digits: the sum hi + lo, |lo| <= ulp(hi) / 2 (Dekker 1971; Hida, Li and Bailey
// 2001). It is used if rounding to double might decide whether and where a ray meets the box.
struct DoubleDouble {
    double hi = 0;
    double lo = 0;

    double rounded() const { return hi + lo; }
    bool finite() const { return std::isfinite(hi) && std::isfinite(lo); }
};

inline DoubleDouble exact_sum(double a, double b) {
    const double sum = a + b;
    const double b_part = sum - a;
    return {sum, (a - (sum - b_part)) + (b - b_part)};
}

inline DoubleDouble exact_product(double a, double b) {
    const double product = a * b;
    return {product, std::fma(a, b, -product)};
}

inline DoubleDouble operator-(DoubleDouble a) {
    return {-a.hi, -a.lo};
}

inline DoubleDouble operator+(DoubleDouble a, DoubleDouble b) {
    const DoubleDouble high = exact_sum(a.hi, b.hi);
    const DoubleDouble low = exact_sum(a.lo, b.lo);
    const DoubleDouble middle = exact_sum(high.hi, high.lo + low.hi);
    return exact_sum(middle.hi, middle.lo + low.lo);
}

inline DoubleDouble operator-(DoubleDouble a, DoubleDouble b) {
    return a + -b;
}

inline DoubleDouble operator*(DoubleDouble a, DoubleDouble b) {
    const DoubleDouble product = exact_product(a.hi, b.hi);
    return exact_sum(product.hi, product.lo + (a.hi * b.lo + a.lo * b.hi));
}

inline DoubleDouble operator/(DoubleDouble a, DoubleDouble b) {
    const double first = a.hi / b.hi;
    const DoubleDouble rest = a - b * DoubleDouble{first, 0};
    const double second = rest.hi / b.hi;
    const double third = (rest - b * DoubleDouble{second, 0}).hi / b.hi;
    return exact_sum(first, second) + DoubleDouble{third, 0};
}

inline bool operator<(DoubleDouble a, DoubleDouble b) {
    return a.hi < b.hi || (a.hi == b.hi && a.lo < b.lo);
}

// Returns the median of one or more values: for an even number, the mean of the middle two.
inline double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const std::size_t middle = values.size() / 2;
    return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

}  // namespace lamina
