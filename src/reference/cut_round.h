// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "simd/lane_set.h"

namespace lamina {

// One piece of each segment of a vector, where `kept` has its bit (PieceBatch).
struct CutRound {
    alignas(64) std::int64_t interval[longest_vector];
    alignas(64) double from[longest_vector];
    alignas(64) double to[longest_vector];
    alignas(64) double start[longest_vector];
    alignas(64) double end[longest_vector];
    std::uint8_t kept;  // a bit each
};

}  // namespace lamina
