// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "lamina/error_figure.h"
#include "lamina/scene.h"

namespace lamina {

// Short account of what runs for a picture.
struct PlanSummary {
    // Something that the scene does not need, and why it may be left out.
    struct LeftOut {
        std::string name, reason;
    };

    Method method = Method::slice;
    Target target = Target::float32;
    int slabs = 0;  // number of slabs of slicing
    // Error of the picture, with the rounding of compositing; below 255.
    ErrorFigure error;
    std::vector<LeftOut> left_out;
};

}  // namespace lamina
