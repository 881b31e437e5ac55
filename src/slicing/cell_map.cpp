// SPDX-License-Identifier: Apache-2.0
#include "slicing/cell_map.h"

#include <algorithm>

namespace lamina {

CellMap make_cell_map(const OccupiedBricks* occupied, const OccupiedBricks* varied) {
    CellMap map;
    const OccupiedBricks* const any = occupied != nullptr ? occupied : varied;
    if (any == nullptr) return map;
    map.count = any->count;
    const std::size_t bricks = any->distance.size();
    map.kinds.resize(bricks + 3);
    const auto reach = [](std::uint8_t distance) {
        return std::min<int>(distance, CellMap::farthest);
    };
    for (std::size_t i = 0; i < bricks; ++i) {
        const int empty = occupied != nullptr ? reach(occupied->distance[i]) : 0;
        const int constant = varied != nullptr ? reach(varied->distance[i]) : 0;
        map.kinds[i] = static_cast<std::uint8_t>(empty > 0      ? empty
                                                 : constant > 0 ? CellMap::constant + constant
                                                                : 0);
    }
    return map;
}

}  // namespace lamina
