// SPDX-License-Identifier: Apache-2.0
#include "mesh/predicates.h"

#include <limits>

#include "base/arithmetic.h"

namespace lamina {
namespace {

// Half an ulp of 1, which Shewchuk calls epsilon.
constexpr double half_ulp = std::numeric_limits<double>::epsilon() / 2;
// Shewchuk's error bound for orient3d ("o3derrboundA"), as a share of the permanent.
constexpr double error_bound = (7 + 56 * half_ulp) * half_ulp;

// An exact sum: nonoverlapping doubles, smallest first (Shewchuk, GROW-EXPANSION, no zeros).
class Expansion {
  public:
    void add(double term) {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < count_; ++i) {
            const DoubleDouble sum = exact_sum(term, components_[i]);
            if (sum.lo != 0) components_[kept++] = sum.lo;
            term = sum.hi;
        }
        if (term != 0) components_[kept++] = term;
        count_ = kept;
    }
    void add_product(double a, double b, double c) {
        if (a == 0 || b == 0 || c == 0) return;
        const DoubleDouble ab = exact_product(a, b);
        for (const double factor : {ab.lo, ab.hi}) {
            const DoubleDouble abc = exact_product(factor, c);
            add(abc.lo);
            add(abc.hi);
        }
    }
    int sign() const {
        if (count_ == 0) return 0;
        return components_[count_ - 1] > 0 ? 1 : -1;
    }

  private:
    // At most 6 * 8 * 4 terms: six products of three differences, each the sum of two doubles.
    std::array<double, 192> components_;
    std::size_t count_ = 0;
};

using ExactVector = std::array<DoubleDouble, 3>;

ExactVector exact_difference(const glm::dvec3& a, const glm::dvec3& b) {
    return {exact_sum(a.x, -b.x), exact_sum(a.y, -b.y), exact_sum(a.z, -b.z)};
}

int exact_sign(const ExactVector& a, const ExactVector& b, const ExactVector& c) {
    Expansion determinant;
    const auto add = [&](std::size_t i, std::size_t j, std::size_t k, double sign) {
        for (const double x : {a[i].hi, a[i].lo})
            for (const double y : {b[j].hi, b[j].lo})
                for (const double z : {c[k].hi, c[k].lo}) determinant.add_product(sign * x, y, z);
    };
    add(0, 1, 2, 1), add(1, 2, 0, 1), add(2, 0, 1, 1);
    add(0, 2, 1, -1), add(1, 0, 2, -1), add(2, 1, 0, -1);
    return determinant.sign();
}

}  // namespace

int sign_of_determinant(const glm::dvec3& a, const glm::dvec3& a0, const glm::dvec3& b,
                        const glm::dvec3& b0, const glm::dvec3& c, const glm::dvec3& c0) {
    const glm::dvec3 u = a - a0, v = b - b0, w = c - c0;
    const double vw = v.x * w.y, wv = v.y * w.x;
    const double wu = w.x * u.y, uw = w.y * u.x;
    const double uv = u.x * v.y, vu = u.y * v.x;
    const double determinant = u.z * (vw - wv) + v.z * (wu - uw) + w.z * (uv - vu);
    const double permanent = (std::abs(vw) + std::abs(wv)) * std::abs(u.z) +
                             (std::abs(wu) + std::abs(uw)) * std::abs(v.z) +
                             (std::abs(uv) + std::abs(vu)) * std::abs(w.z);
    const double bound = error_bound * permanent;
    if (determinant > bound) return 1;
    if (-determinant > bound) return -1;
    return exact_sign(exact_difference(a, a0), exact_difference(b, b0), exact_difference(c, c0));
}

}  // namespace lamina
