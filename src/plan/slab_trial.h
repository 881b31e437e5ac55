// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace lamina {

// What slicing into so many slabs was found to cost in accuracy, on rays all over the picture.
struct SlabTrial {
    int slabs = 1;
    double error = 0;         // Linf of colour and opacity, in 1/255
    std::int64_t rays = 0;    // that were tried
    double goal = 0;          // what the error may be: slab_error_goal(), in 1/255
    std::int64_t traced = 0;  // of the rays, held against the reference tracer
    // The picture may be off by more: the rays are those of a smaller one, or not all of them were
    // traced, and the tracer found more than pictures of other numbers of slabs show.
    bool doubtful = false;
    bool keeps_goal() const { return error <= goal; }

    friend bool operator==(const SlabTrial&, const SlabTrial&) = default;
};

}  // namespace lamina
