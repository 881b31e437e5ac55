// SPDX-License-Identifier: Apache-2.0
#include "tiles/cpu_capabilities.h"

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstdint>
#include <limits>

#include "simd/instruction_set.h"

namespace lamina {

Capabilities cpu_capabilities() {
    constexpr int largest_edge = 32768;  // pixel coordinates are exact in floats
    Capabilities capabilities;
    capabilities.renderer = fmt::format("cpu: {}", instruction_set());
    const auto allowed =
        tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
    capabilities.threads =
        std::min(tbb::this_task_arena::max_concurrency(), static_cast<int>(allowed));
    capabilities.cpu = true;
    capabilities.max_texture_size = largest_edge;
    capabilities.max_3d_texture_size = std::numeric_limits<int>::max();
    // Gather instructions address memory by vectors of signed 32-bit numbers.
    capabilities.max_texture_bytes = std::uint64_t{std::numeric_limits<std::int32_t>::max()};
    return capabilities;
}

}  // namespace lamina
