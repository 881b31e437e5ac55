// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lamina/scene.h"

namespace lamina {

// A short account of what runs for a picture.
struct PlanSummary {
    // Something that the scene does not need, and why it may be left out.
    struct LeftOut {
        std::string name, reason;
    };

    Method method = Method::slice;
    Target target = Target::float32;
    int slabs = 0;     // of slicing
    double error = 0;  // in 1/255, of what was chosen, as far as it was measured
    // In 1/255, below 255: what the picture is expected to miss the truth by at most, with what
    // compositing rounds. None where a part of it is not known: slabs, tables or trees that the
    // scene states and nothing was measured of, and targets of fewer bits than float32 for tets.
    std::optional<double> expected_error;
    std::vector<LeftOut> left_out;
};

}  // namespace lamina
