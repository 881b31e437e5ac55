// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace lamina {

// The error of slicing into so many slabs, found on rays all over the picture.
struct SlabTrial {
    int slabs = 1;
    double error = 0;         // Linf of colour and opacity, in 1/255
    std::int64_t rays = 0;    // number of rays that were tried
    double goal = 0;          // largest error that is allowed: slab_error_goal(), in 1/255
    std::int64_t traced = 0;  // number of these rays that were compared with the reference tracer
    // The picture's error may be larger. The rays are those of a smaller picture, or not all of
    // them were traced and the tracer found a larger error than the comparison with other numbers
    // of slabs.
    bool doubtful = false;
    bool keeps_goal() const { return error <= goal; }

    friend bool operator==(const SlabTrial&, const SlabTrial&) = default;
};

}  // namespace lamina
