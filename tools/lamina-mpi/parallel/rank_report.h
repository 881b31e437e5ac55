// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

namespace lamina {

// The report of one rank on a frame: what it took there. Ranks send it as bytes.
struct RankReport {
    std::array<char, 64> machine{};  // its name, ends with 0
    std::int32_t threads = 0;
    double draw_ms = 0;       // to plan and draw its share
    double composite_ms = 0;  // from then on: compositing, and waiting for other ranks
    std::int64_t segments = 0;
    std::int64_t bytes_sent = 0, messages_sent = 0;
    std::int64_t peak_memory = 0;  // resident, bytes, since the start
};

}  // namespace lamina
