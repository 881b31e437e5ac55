// SPDX-License-Identifier: Apache-2.0
#include "volume/gradient_noise.h"

#include <cmath>

namespace lamina {
namespace {

// The finaliser of splitmix64 (Steele, Lea and Flood, "Fast splittable pseudorandom number
// generators", 2014).
std::uint64_t mix(std::uint64_t bits) {
    bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9u;
    bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebu;
    return bits ^ (bits >> 31);
}

// 21 bits to -1..1.
double component(std::uint64_t bits) {
    return static_cast<double>(bits & 0x1fffff) * 0x1p-20 - 1;
}

double blend(double a, double b, double weight) {
    return a + weight * (b - a);
}

}  // namespace

GradientNoise::Node GradientNoise::node(std::int64_t x, double y, double z) const {
    const double cell_y = std::floor(y);
    const double cell_z = std::floor(z);
    Node corners[4];
    for (int corner = 0; corner < 4; ++corner) {
        const double corner_y = cell_y + (corner & 1);
        const double corner_z = cell_z + (corner >> 1);
        // Coordinates of 21 bits each; noise repeats beyond 2^21 lattice cells.
        const auto key =
            static_cast<std::uint64_t>(x & 0x1fffff) |
            static_cast<std::uint64_t>(static_cast<std::int64_t>(corner_y) & 0x1fffff) << 21 |
            static_cast<std::uint64_t>(static_cast<std::int64_t>(corner_z) & 0x1fffff) << 42;
        const std::uint64_t bits = mix(key * 0x9e3779b97f4a7c15u + seed_);
        corners[corner] = {
            component(bits >> 21) * (y - corner_y) + component(bits >> 42) * (z - corner_z),
            component(bits)};
    }
    const double weight_y = fade(y - cell_y);
    const double weight_z = fade(z - cell_z);
    return {blend(blend(corners[0].value, corners[1].value, weight_y),
                  blend(corners[2].value, corners[3].value, weight_y), weight_z),
            blend(blend(corners[0].slope, corners[1].slope, weight_y),
                  blend(corners[2].slope, corners[3].slope, weight_y), weight_z)};
}

double GradientNoise::at(double x, double y, double z) const {
    double value = 0;
    add_row(x, 1, y, z, 1, 1, &value);
    return value;
}

void GradientNoise::add_row(double first, double step, double y, double z, double amplitude,
                            std::int64_t count, double* values) const {
    auto cell = static_cast<std::int64_t>(std::floor(first));
    Node left = node(cell, y, z);
    Node right = node(cell + 1, y, z);
    for (std::int64_t i = 0; i < count; ++i) {
        const double x = first + static_cast<double>(i) * step;
        if (x >= static_cast<double>(cell + 1)) {
            const auto next = static_cast<std::int64_t>(std::floor(x));
            left = next == cell + 1 ? right : node(next, y, z);
            right = node(next + 1, y, z);
            cell = next;
        }
        const double t = x - static_cast<double>(cell);
        values[i] += amplitude * blend(left.value + left.slope * t,
                                       right.value + right.slope * (t - 1), fade(t));
    }
}

}  // namespace lamina
