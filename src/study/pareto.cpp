// SPDX-License-Identifier: Apache-2.0
#include "study/pareto.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lamina::study {

std::vector<bool> pareto_front(const std::vector<CostAndError>& points) {
    std::vector<std::size_t> order(points.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        if (points[a].cost != points[b].cost) return points[a].cost < points[b].cost;
        return points[a].error < points[b].error;
    });
    std::vector<bool> front(points.size(), false);
    CostAndError last{-INFINITY, INFINITY};  // of the front, at the largest cost so far
    for (const std::size_t i : order) {
        const CostAndError& point = points[i];
        const bool equal = point.cost == last.cost && point.error == last.error;
        if (!equal && point.error >= last.error) continue;
        front[i] = true;
        last = point;
    }
    return front;
}

}  // namespace lamina::study
