// SPDX-License-Identifier: Apache-2.0
#include "slicing/cell_map.h"

#include <algorithm>

#include "base/parallel.h"

namespace lamina {

CellMap make_cell_map(const OccupiedBricks* occupied, const OccupiedBricks* varied) {
    CellMap map;
    const OccupiedBricks* const any = occupied != nullptr ? occupied : varied;
    if (any == nullptr) return map;
    map.count = any->count;
    const std::size_t bricks = any->distance.size();
    map.kinds = SparseBytes(bricks, occupied != nullptr ? CellMap::farthest : 0);
    parallel_for(static_cast<std::int64_t>(bricks), 1 << 16, [&](std::int64_t number) {
        const auto i = static_cast<std::size_t>(number);
        const int empty = occupied != nullptr ? occupied->distance[i] : 0;
        const int constant = varied != nullptr ? varied->distance[i] : 0;
        map.kinds.set(i, static_cast<std::uint8_t>(empty > 0      ? empty
                                                   : constant > 0 ? CellMap::constant + constant
                                                                  : 0));
    });
    return map;
}

}  // namespace lamina
