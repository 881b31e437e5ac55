// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "lamina/error_norms.h"
#include "lamina/frame_statistics.h"
#include "lamina/scene.h"

namespace lamina::view {

// Settings that were tried, with their error and time.
struct Attempt {
    Scene scene;     // as it was asked for: to go back to
    Scene resolved;  // with everything automatic written out
    // Camera and size of the picture, counted from 1 on: errors of one view can be compared.
    int view = 0;
    std::optional<double> expected;  // error, in 1/255, where one is known before
    double share_measured = 0;       // of the pixels, 0 to 1
    ErrorNorms error;                // of these pixels, in 1/255
    double draw_ms = 0;              // of the picture, with all that was chosen and made for it
    double frame_ms = 0;  // of that, what each further picture of the same settings takes

    // Short texts of settings of `resolved`.
    std::string method;          // "slice"
    std::string classification;  // of slices; the coloring of tets: "preintegrated, linear"
    std::string target;          // "fixed8"
    std::string tree;            // "32x32"; empty: none
    std::string samples;         // "512"; empty: no slices
};

// Returns an attempt with its settings only.
Attempt attempt_of(const Scene& scene, const Scene& resolved);
// Returns Attempt::frame_ms.
double frame_ms_of(const FrameStatistics& statistics);
// Returns the settings as one line: "slice, exact, fixed8, tree 32x32, 1024 slabs".
std::string short_text(const Scene& scene);

}  // namespace lamina::view
