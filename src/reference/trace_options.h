// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "lamina/lighting.h"
#include "scene/half_space.h"

namespace lamina {

struct TraceOptions {
    // Largest error of every channel, as a share of full scale (1.0); 1e-12 .. 1. Of meshes it
    // bounds the error of light: all else is in closed form.
    double tolerance = 1e-5;
    // Free of mistakes (scene/lighting_check.h). Throws Error without its smallest gradient.
    std::optional<Lighting> lighting = {};
    std::vector<HalfSpace> clip = {};  // what is drawn lies in all of them

    static constexpr double smallest_tolerance = 1e-12;  // below it rounding dominates
};

// Throws Error for options out of range.
void check(const TraceOptions& options);

}  // namespace lamina
