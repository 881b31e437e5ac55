// SPDX-License-Identifier: Apache-2.0
#include "slicing/cell_map.h"

#include <algorithm>
#include <vector>

#include "base/parallel.h"

namespace lamina {

CellMap make_cell_map(const OccupiedBricks* occupied, const OccupiedBricks* varied) {
    CellMap map;
    if (varied == nullptr) {
        if (occupied != nullptr) map = {occupied->count, occupied->distance};
        return map;
    }
    map.count = varied->count;
    const std::size_t bricks = varied->distance.size(), together = 1 << 16;
    map.kinds = SparseBytes(bricks, occupied != nullptr ? CellMap::farthest : 0);
    parallel_for(
        static_cast<std::int64_t>((bricks + together - 1) / together), 1, [&](std::int64_t part) {
            const std::size_t first = static_cast<std::size_t>(part) * together;
            std::vector<std::uint8_t> kinds(std::min(together, bricks - first));
            for (std::size_t i = 0; i < kinds.size(); ++i) {
                const int empty = occupied != nullptr ? occupied->distance[first + i] : 0;
                const int constant = varied->distance[first + i];
                kinds[i] = static_cast<std::uint8_t>(empty > 0      ? empty
                                                     : constant > 0 ? CellMap::constant + constant
                                                                    : 0);
            }
            map.kinds.set(first, kinds);
        });
    return map;
}

}  // namespace lamina
