// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace lamina::study {

struct CostAndError {
    double cost = 0, error = 0;  // in any units, the same for all points
};

// For each point whether no other point beats it. A point beats another where it is no larger in
// both numbers and smaller in one.
std::vector<bool> pareto_front(const std::vector<CostAndError>& points);

}  // namespace lamina::study
