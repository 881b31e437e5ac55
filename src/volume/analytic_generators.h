// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "volume/generator.h"

namespace lamina {

// value = x / (size of x - 1): 0, 1, ..., 255 in 256 samples of uint8.
std::unique_ptr<Generator> make_ramp(const GridSize& size);

// 1/2 everywhere.
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

}  // namespace lamina
