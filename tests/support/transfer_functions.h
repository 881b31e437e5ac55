// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <vector>

#include "lamina/transfer_function.h"

namespace lamina::test {

inline TransferKnot knot(double value, const glm::dvec3& color, double extinction) {
    return {value, {color, extinction}};
}

// Over [0, 1], 17 points.
inline TransferFunction smooth() {
    std::vector<TransferKnot> knots;
    for (int i = 0; i <= 16; ++i) {
        const double x = i / 16.0;
        knots.push_back(knot(x, glm::dvec3(x, 1 - x, 0.5 + 0.5 * std::sin(5 * x)), 4 * x * x));
    }
    return TransferFunction::linear(knots);
}

}  // namespace lamina::test
