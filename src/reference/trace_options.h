// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "lamina/lighting.h"

namespace lamina {

struct TraceOptions {
    // Largest error of every channel, as a share of full scale (1.0); 1e-12 .. 1. Of meshes it
    // bounds the error of light: all else is in closed form.
    double tolerance = 1e-5;
    // Free of mistakes (scene/lighting_check.h). Throws Error without its smallest gradient.
    std::optional<Lighting> lighting = {};

    static constexpr double smallest_tolerance = 1e-12;  // below it rounding dominates
};

// Throws Error for options out of range.
void check(const TraceOptions& options);

}  // namespace lamina
