// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bindings.h"

namespace lamina::python {

// A picture and what belongs to it, as it was when it was drawn.
struct Drawn {
    std::shared_ptr<Image> picture;       // null if it was traced
    std::shared_ptr<PreciseImage> truth;  // null if it was drawn
    Scene scene;                          // resolved
    PlanSummary plan;                     // of slicing and projection
    std::string explanation;
    FrameStatistics statistics;
    std::vector<std::string> warnings;

    py::array array() const;
    // Returns what is drawn beside the picture; null if nothing is.
    const std::shared_ptr<const Image>& annotations() const {
        return truth ? truth->annotations : picture->annotations;
    }
    bool is_traced() const { return truth || scene.method == Method::trace; }
    // In 1/255: the plan's, or the tracer's estimate; none if it is unknown.
    std::optional<double> error() const;
    std::string error_kind() const;  // a word of ErrorKind, or "estimated" by the tracer
    // In 1/255: bound for rays along ramps; none if error() holds for them, too.
    std::optional<double> error_along_ramps() const;
};

void bind_drawn(py::module_& module);

}  // namespace lamina::python
