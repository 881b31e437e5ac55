// SPDX-License-Identifier: Apache-2.0
// A second implementation of fixed-point compositing, from LaMar 2004 and docs/numerics.md,
// sections 2 and 3, in exact fractions and long double. It uses nothing of src/compositing.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "compositing/codes.h"

namespace lamina::oracle {

using Wide = std::uint64_t;  // holds 65535^3

// Returns numerator / denominator, rounded to the nearest whole number. There are no ties, because
// M is odd.
inline std::uint32_t nearest(Wide numerator, Wide denominator) {
    const Wide below = numerator / denominator, rest = numerator % denominator;
    return static_cast<std::uint32_t>(2 * rest > denominator ? below + 1 : below);
}

inline std::uint32_t over(bool fused, Wide color, Wide alpha, Wide below, Wide largest) {
    if (fused) return nearest(color * alpha + below * (largest - alpha), largest);
    return nearest(color * alpha, largest) + nearest(below * (largest - alpha), largest);
}

inline std::uint32_t under(bool fused, Wide color, Wide alpha, std::uint32_t above, Wide opacity,
                           Wide largest) {
    if (fused) return above + nearest(color * alpha * (largest - opacity), largest * largest);
    return above + nearest(Wide{nearest(color * alpha, largest)} * (largest - opacity), largest);
}

// Returns the permutation of docs/numerics.md, section 2, with splitmix64 as Steele, Lea and Flood
// print it.
inline std::vector<int> permutation(int period, std::uint64_t seed) {
    std::uint64_t x = seed;
    const auto next = [&x] {
        x += 11400714819323198485u;
        std::uint64_t z = x;
        z ^= z >> 30;
        z *= 13787848793156543929u;
        z ^= z >> 27;
        z *= 10723151780598845931u;
        z ^= z >> 31;
        return z;
    };
    std::vector<int> order;
    for (int i = 0; i < period; ++i) order.push_back(i);
    for (int i = period - 1; i >= 1; --i) {
        const auto j = static_cast<std::size_t>(next() % static_cast<std::uint64_t>(i + 1));
        std::swap(order[static_cast<std::size_t>(i)], order[j]);
    }
    return order;
}

// Returns 1 - (1 - A)^share.
inline long double opacity(long double unit_opacity, long double share) {
    return unit_opacity >= 1 ? 1.0L : -std::expm1(share * std::log1p(-unit_opacity));
}

// Splits M * opacity into a whole number and the rest; 1e-9 below a whole number counts as that
// number.
inline std::pair<std::uint32_t, long double> parts(long double scaled) {
    const long double whole = std::floor(scaled + 1e-9L);
    return {static_cast<std::uint32_t>(whole), std::fmax(scaled - whole, 0.0L)};
}

// Returns random per-unit opacities up to `most`.
inline std::vector<double> random_ray(int samples, double most, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::vector<double> ray;
    for (int i = 0; i < samples; ++i) ray.push_back(most * static_cast<double>(random()) * 0x1p-32);
    return ray;
}

}  // namespace lamina::oracle
