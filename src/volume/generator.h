// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

namespace lamina {

using GridSize = std::array<std::int64_t, 3>;

// A field on a grid, computed row by row.
class Generator {
  public:
    virtual ~Generator() = default;

    // Computes the samples (0, y, z), (1, y, z), ..., each in 0..1. Safe from several threads at
    // once.
    virtual void row(std::int64_t y, std::int64_t z, double* values) const = 0;
};

// The position of sample i of n in the unit box: 0 for the first, 1 for the last, 1/2 for a single
// one.
inline double unit_position(std::int64_t i, std::int64_t n) {
    return n == 1 ? 0.5 : static_cast<double>(i) / static_cast<double>(n - 1);
}

}  // namespace lamina
