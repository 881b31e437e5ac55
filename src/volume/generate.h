// SPDX-License-Identifier: Apache-2.0
// Volumes made by formula (docs/scene.md, volume.generate), the same on every machine.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/output_file.h"
#include "lamina/volume.h"

namespace lamina {

constexpr std::int64_t largest_generated_axis = 2048;  // samples

const std::vector<std::string>& generator_names();

// Returns the grid of a request: the unit box with samples at its faces (`node`; an axis of one
// sample is `cell`), or for "ramp" voxels of edge 1 with the first sample at the origin. Throws
// Error if name, size (1..2048 along each axis) or type is not valid.
Grid generated_grid(const GeneratorRequest& request);

// Generate values over 0..255, 0..65535 or 0..1. Parallel, with progress. Both throw Error.
Volume generate(const GeneratorRequest& request);  // in memory
// Works slab by slab, in less than 200 MB of memory at any size.
void generate_nrrd(AtomicFile& file, const GeneratorRequest& request);

// exp(x), x in -700..700, and cos(2 pi turns), with the same bits on every machine: generated data
// are told apart by their hashes, and libraries round in different ways.
double portable_exp(double x);
double portable_cos_turns(double turns);

}  // namespace lamina
