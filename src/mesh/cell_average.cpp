// SPDX-License-Identifier: Apache-2.0
#include "mesh/cell_average.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <vector>

namespace lamina {

MeshScalar average_to_points(std::size_t point_count, std::span<const Tet> tets,
                             const MeshScalar& scalar) {
    assert(scalar.values.size() == tets.size());
    const auto finite =
        std::ranges::find_if(scalar.values, [](double value) { return std::isfinite(value); });
    const double elsewhere = finite == scalar.values.end() ? 0.0 : *finite;

    MeshScalar result{scalar.name, std::vector<double>(point_count, 0.0)};
    std::vector<std::int32_t> around(point_count, 0);
    for (const Tet& tet : tets) {
        for (const std::int32_t corner : tet) ++around[static_cast<std::size_t>(corner)];
    }
    for (std::size_t i = 0; i < tets.size(); ++i) {
        for (const std::int32_t corner : tets[i]) {
            // Values are divided before they are added, so that no sum overflows.
            const auto point = static_cast<std::size_t>(corner);
            result.values[point] += scalar.values[i] / around[point];
        }
    }
    for (std::size_t point = 0; point < point_count; ++point) {
        if (around[point] == 0) result.values[point] = elsewhere;
    }
    return result;
}

}  // namespace lamina
