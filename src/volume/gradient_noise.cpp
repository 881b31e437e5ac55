// SPDX-License-Identifier: Apache-2.0
#include "volume/gradient_noise.h"

#include <cmath>
#include <limits>

namespace lamina {
namespace {

// The finaliser of splitmix64 (Steele, Lea and Flood, "Fast splittable pseudorandom number
// generators", 2014).
std::uint64_t mix(std::uint64_t bits) {
    bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9u;
    bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebu;
    return bits ^ (bits >> 31);
}

// Maps 21 bits to -1..1.
double component(std::uint64_t bits) {
    return static_cast<double>(bits & 0x1fffff) * 0x1p-20 - 1;
}

// Returns a lattice coordinate in 21 bits, so noise repeats beyond 2^21 cells.
std::uint64_t lattice_bits(std::int64_t coordinate) {
    return static_cast<std::uint64_t>(coordinate) & 0x1fffff;
}

double blend(double a, double b, double weight) {
    return a + weight * (b - a);
}

// The four lattice lines along x around (y, z).
struct Lines {
    std::uint64_t key[4];             // of their lattice points, without x
    double offset_y[4], offset_z[4];  // of (y, z) from the line
    double weight_y, weight_z;        // of the lines at larger y, at larger z

    Lines(double y, double z) {
        const double cell_y = std::floor(y);
        const double cell_z = std::floor(z);
        weight_y = fade(y - cell_y);
        weight_z = fade(z - cell_z);
        for (int line = 0; line < 4; ++line) {
            const auto line_y = static_cast<std::int64_t>(cell_y) + (line & 1);
            const auto line_z = static_cast<std::int64_t>(cell_z) + (line >> 1);
            key[line] = lattice_bits(line_y) << 21 | lattice_bits(line_z) << 42;
            offset_y[line] = y - static_cast<double>(line_y);
            offset_z[line] = z - static_cast<double>(line_z);
        }
    }

    double interpolate(const double* values) const {
        return blend(blend(values[0], values[1], weight_y), blend(values[2], values[3], weight_y),
                     weight_z);
    }
};

// The gradients at one lattice coordinate of x, interpolated over y and z, contribute value + slope
// * d at distance d along x.
struct Node {
    double value;
    double slope;
};

Node node(std::uint64_t seed, const Lines& lines, std::int64_t x) {
    double values[4], slopes[4];
    for (int line = 0; line < 4; ++line) {
        const std::uint64_t bits =
            mix((lines.key[line] | lattice_bits(x)) * 0x9e3779b97f4a7c15u + seed);
        slopes[line] = component(bits);
        values[line] = component(bits >> 21) * lines.offset_y[line] +
                       component(bits >> 42) * lines.offset_z[line];
    }
    return {lines.interpolate(values), lines.interpolate(slopes)};
}

}  // namespace

double GradientNoise::at(double x, double y, double z) const {
    double value = 0;
    add_row(x, 1, y, z, 1, 1, &value);
    return value;
}

void GradientNoise::add_row(double first, double step, double y, double z, double amplitude,
                            int count, double* values) const {
    const Lines lines(y, z);
    Node right{};
    std::int64_t right_x = std::numeric_limits<std::int64_t>::min();
    const auto position = [=](int i) { return first + static_cast<double>(i) * step; };
    for (int begin = 0; begin < count;) {
        const double cell = std::floor(position(begin));
        int end = begin + 1;  // of the samples in this cell
        while (end < count && position(end) < cell + 1) ++end;
        const auto left_x = static_cast<std::int64_t>(cell);
        const Node left = left_x == right_x ? right : node(seed_, lines, left_x);
        right_x = left_x + 1;
        right = node(seed_, lines, right_x);
        for (int i = begin; i < end; ++i) {
            const double t = position(i) - cell;
            values[i] += amplitude * blend(left.value + left.slope * t,
                                           right.value + right.slope * (t - 1), fade(t));
        }
        begin = end;
    }
}

}  // namespace lamina
