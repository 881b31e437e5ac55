// SPDX-License-Identifier: Apache-2.0
#include "volume/gradient_noise.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lamina {
namespace {

// The smooth step 6 t^5 - 15 t^4 + 10 t^3, for t in 0..1.
double fade(double t) {
    return t * t * t * (t * (t * 6 - 15) + 10);
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
    std::uint64_t key[4];             // keys of their lattice points, without x
    double offset_y[4], offset_z[4];  // distance of (y, z) from the line
    double weight_y, weight_z;        // weights of the lines at larger y, at larger z

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

// The noise contribution of lattice plane x along one row: value + slope * d at distance d from the
// plane.
struct Node {
    double value;
    double slope;
};

Node node(std::uint64_t seed, const Lines& lines, std::int64_t x) {
    double values[4], slopes[4];
    for (int line = 0; line < 4; ++line) {
        const std::uint64_t bits =
            mixed_bits((lines.key[line] | lattice_bits(x)) * 0x9e3779b97f4a7c15u + seed);
        slopes[line] = component(bits);
        values[line] = component(bits >> 21) * lines.offset_y[line] +
                       component(bits >> 42) * lines.offset_z[line];
    }
    return {lines.interpolate(values), lines.interpolate(slopes)};
}

}  // namespace

std::uint64_t mixed_bits(std::uint64_t bits) {
    bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9u;
    bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebu;
    return bits ^ (bits >> 31);
}

double normal_number(std::uint64_t bits) {
    double sum = 0;
    for (int part = 0; part < 4; ++part) sum += static_cast<double>(bits >> (16 * part) & 0xffff);
    // The sum of four numbers in 0..1 has mean 2 and variance 4/12.
    return (sum / 65535 - 2) * 1.7320508075688772;
}

double smooth_step(double t) {
    return fade(std::clamp(t, 0.0, 1.0));
}

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
        int end = begin + 1;  // end of the samples in this cell
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
