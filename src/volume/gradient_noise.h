// SPDX-License-Identifier: Apache-2.0
// Noise of generated data: the same bits on every machine.
#pragma once

#include <cstdint>

namespace lamina {

// splitmix64's finaliser (Steele et al., "Fast splittable pseudorandom number generators", 2014).
std::uint64_t mixed_bits(std::uint64_t bits);

// Returns a number like one of a normal distribution of mean 0 and deviation 1, within -3.5..3.5:
// the sum of four uniform ones (Irwin and Hall). `bits` are random.
double normal_number(std::uint64_t bits);

// Returns 6 t^5 - 15 t^4 + 10 t^3 of t clamped to 0..1: a step without kinks.
double smooth_step(double t);

// Gradient noise (Perlin, "An image synthesizer", 1985) with the fade curve of "Improving noise",
// 2002, and gradients from a hash of the lattice point. About -1..1, mean 0, 0 at lattice points.
class GradientNoise {
  public:
    explicit GradientNoise(std::uint64_t seed) : seed_(seed) {}

    double at(double x, double y, double z) const;

    // values[i] += amplitude * at(first + i * step, y, z). Terms that depend only on y and z are
    // computed once a lattice cell, so a sample costs one interpolation. `step` > 0.
    void add_row(double first, double step, double y, double z, double amplitude, int count,
                 double* values) const;

  private:
    std::uint64_t seed_;
};

}  // namespace lamina
