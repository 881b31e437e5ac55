// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lamina/scene.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// The range of the finite values of the scene's volume, or of its mesh where it has no volume. It
// reads the data; of a file that did not change since, it knows the range. Throws Error where the
// data cannot be read.
ValueRange data_range(const Scene& scene);

}  // namespace lamina
