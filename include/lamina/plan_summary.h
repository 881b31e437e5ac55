// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "lamina/error_figure.h"
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
    int slabs = 0;  // of slicing
    // The picture's error with what compositing rounds, below 255.
    ErrorFigure error;
    std::vector<LeftOut> left_out;
};

}  // namespace lamina
