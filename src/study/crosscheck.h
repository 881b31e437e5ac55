// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "plan/capabilities.h"
#include "study/error_budget.h"
#include "study/interleaved_times.h"
#include "study/reference_store.h"

namespace lamina::study {

struct CrosscheckSettings {
    // Of meshes made from the volume, beside the scene's own.
    std::vector<double> tolerances{0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001};
    // No finer mesh once both methods agree within the scene's max_error, or at its max_tets.
    bool stop_when_agreed = true;
    std::vector<int> samples{64, 128, 256, 512, 1024};  // slabs, beside the scene's own
    int rounds = 3;                                     // of frames, interleaved; >= 3
};

// One volume by both methods, the sampling of each from coarse to fine.
struct Crosscheck {
    struct Slicing {
        int samples = 0;
        Image picture;
        ImageError error;  // against the traced volume
        FrameTimes times;
        std::int64_t bytes = 0;
    };
    struct Projection {
        double tolerance = 0;   // 0: a mesh from a file
        double mesh_error = 0;  // of the range of values, certified; 0: not known
        bool stopped = false;   // at max_tets
        std::int64_t tets = 0;
        double mesh_ms = 0;  // to make or read it
        Image traced, picture;
        ImageError mesh_part, method_part, error;  // the last against the traced volume
        FrameTimes times;
        std::int64_t bytes = 0;
    };
    struct Pair {
        ErrorNorms raw;  // projected - sliced
        std::size_t dominant = 0;
    };

    FourPictures pictures;  // at the scene's own settings
    int samples = 0;        // of these
    double tolerance = 0;
    double reference_error = 0;  // of the traced volume, in 1/255
    double reference_ms = 0;
    std::vector<Slicing> slicings;         // samples growing
    std::vector<Projection> projections;   // tolerances falling
    std::vector<std::vector<Pair>> pairs;  // [projection][slicing]
};

// Draws and traces everything. The scene has a volume; without a mesh, one of tolerance .02 is made
// from it. Throws Error.
Crosscheck crosscheck(const Scene& scene, const CrosscheckSettings& settings,
                      const Capabilities& capabilities);

}  // namespace lamina::study
