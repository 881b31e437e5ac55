// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>

namespace lamina {

// exp(x), x in -700..700, and cos(2 pi turns), with the same bits on every machine: generated data
// are told apart by their hashes, and libraries round in different ways.
double portable_exp(double x);
double portable_cos_turns(double turns);

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

using GridSize = std::array<std::int64_t, 3>;

// A field on a grid, computed row by row.
class Generator {
  public:
    virtual ~Generator() = default;

    // Computes the samples (0, y, z), (1, y, z), ..., each in 0..1. Safe from several threads at
    // once.
    virtual void row(std::int64_t y, std::int64_t z, double* values) const = 0;
};

// Returns the position of sample i of n in the unit box: 0 for the first, 1 for the last, 1/2 for a
// single one.
inline double unit_position(std::int64_t i, std::int64_t n) {
    return n == 1 ? 0.5 : static_cast<double>(i) / static_cast<double>(n - 1);
}

// The value x / (size of x - 1): 0, 1, ..., 255 in 256 samples of uint8.
std::unique_ptr<Generator> make_ramp(const GridSize& size);

// The value 1/2 everywhere.
std::unique_ptr<Generator> make_constant(const GridSize& size);

// The test signal of Marschner and Lobb, "An evaluation of reconstruction filters for volume
// rendering", Visualization 1994, eq. 5, with f_M = 6 and alpha = 0.25, over [-1,1]^3.
std::unique_ptr<Generator> make_marschner_lobb(const GridSize& size);

// A smooth sum of Gaussians of several widths, divided by its maximum.
std::unique_ptr<Generator> make_gaussians(const GridSize& size);

// Thin dense sheets, as in LaMar's tests: 1 inside, 0 outside. Two sheets are perpendicular to z,
// of one sample and of two samples. Two are oblique and take two samples along z each. One takes
// two samples along x.
std::unique_ptr<Generator> make_sheets(const GridSize& size);

// A field that looks like a turbulent mixing layer after a Richtmyer-Meshkov instability. Light
// fluid (0) lies at small x, heavy fluid (1) at large x. Narrow spikes of heavy fluid reach into
// the light one, and broad bubbles of light fluid into the heavy one. In between both are mixed
// down to the scale of a few samples, so that a finer grid shows finer eddies.
std::unique_ptr<Generator> make_mixing(const GridSize& size);

}  // namespace lamina
