// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace lamina::study {

struct CostAndError {
    double cost = 0, error = 0;  // in any units, the same of all points
};

// Which points no other one beats: has as little of both, and less of one.
std::vector<bool> pareto_front(const std::vector<CostAndError>& points);

}  // namespace lamina::study
