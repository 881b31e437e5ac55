// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace lamina::view {

// Time and memory of a picture. The stages are those that were done for it, and add up to the
// whole.
struct FrameCost {
    double ms = 0;
    bool moving = false;
    std::vector<std::pair<std::string, double>> stages;  // ms, in the order in which they are done
};

}  // namespace lamina::view
