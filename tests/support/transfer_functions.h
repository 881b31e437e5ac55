// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <vector>

#include "lamina/transfer_function.h"

namespace lamina::test {

inline TransferKnot knot(double value, const glm::dvec3& color, double extinction) {
    return {value, {color, extinction}};
}

// Returns a smooth function over [0, 1] with 17 points.
inline TransferFunction smooth() {
    std::vector<TransferKnot> knots;
    for (int i = 0; i <= 16; ++i) {
        const double x = i / 16.0;
        knots.push_back(knot(x, glm::dvec3(x, 1 - x, 0.5 + 0.5 * std::sin(5 * x)), 4 * x * x));
    }
    return TransferFunction::linear(knots);
}

// Returns a function with a narrow peak and a step.
inline TransferFunction peak_and_step() {
    return TransferFunction::linear(
        {knot(0, glm::dvec3(1, 0, 0), 0), knot(.3, glm::dvec3(1, .5, 0), 0),
         knot(.303, glm::dvec3(1, .8, .2), 60), knot(.306, glm::dvec3(0, .5, 1), 0),
         knot(.6, glm::dvec3(1, 0, 1), 1), knot(.6, glm::dvec3(0, 0, 1), 5),
         knot(1, glm::dvec3(0, 1, 0), 8)});
}

}  // namespace lamina::test
