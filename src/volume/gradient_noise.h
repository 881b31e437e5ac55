// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace lamina {

// Gradient noise (Perlin, "An image synthesizer", SIGGRAPH 1985) with the fade curve of "Improving
// noise", 2002, and gradients from a hash of the lattice point. Values are about -1..1 with mean 0
// and are zero at lattice points. They are the same on every machine.
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

// The smooth step 6 t^5 - 15 t^4 + 10 t^3, for t in 0..1.
inline double fade(double t) {
    return t * t * t * (t * (t * 6 - 15) + 10);
}

}  // namespace lamina
