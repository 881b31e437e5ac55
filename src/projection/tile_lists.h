// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "scene/camera.h"

namespace lamina {

// Lists, for each tile of a picture that some items cover, these items in their order. A workgroup
// of a compute shader draws a tile (shaders/gl/tile.glsl). Entry: what is listed of an item.
template <typename Entry>
struct TileLists {
    static constexpr int size = 8;  // pixels along a side

    struct Tile {
        std::uint32_t column, row;  // its upper left pixel; row 0 is the top
        std::uint32_t first, end;   // range of `entries`
    };
    std::vector<Tile> tiles;
    std::vector<Entry> entries;

    // Returns the number of tiles along an edge of so many pixels.
    static std::size_t count(int pixels) {
        return (static_cast<std::size_t>(pixels) + size - 1) / size;
    }

    // Returns the number of tiles that an item covers: of its entries.
    static std::size_t count(const PixelArea& area) {
        if (area.empty()) return 0;
        const auto tiles = [](int first, int last) {
            return static_cast<std::size_t>(last / size - first / size + 1);
        };
        return tiles(area.first_column, area.last_column) * tiles(area.first_row, area.last_row);
    }

    // Returns the number of entries that list() would make.
    static std::size_t count(std::span<const PixelArea> areas) {
        std::size_t sum = 0;
        for (const PixelArea& area : areas) sum += count(area);
        return sum;
    }

    // Returns how many items, from the first on, have at most `most` entries together: one or more,
    // unless there are none.
    static std::size_t fitting(std::span<const PixelArea> areas, std::size_t most) {
        std::size_t items = 0;
        for (std::size_t sum = 0; items < areas.size(); ++items) {
            sum += count(areas[items]);
            if (sum > most) break;
        }
        return std::max(items, std::min<std::size_t>(areas.size(), 1));
    }

    // `areas`: the pixels inside the picture that each item may cover; may be empty. Their
    // entries must be fewer than 2^32, which callers see to by count() or fitting().
    // `entry(item, column, row)`: the entry of an item for the tile of this upper left pixel.
    template <typename MakeEntry>
    void list(std::span<const PixelArea> areas, int width, int height, const MakeEntry& entry) {
        assert(count(areas) <= std::numeric_limits<std::uint32_t>::max());
        const std::size_t columns = count(width);
        const auto for_each_tile = [&](const auto& visit) {
            for (std::size_t item = 0; item < areas.size(); ++item) {
                const PixelArea& area = areas[item];
                if (area.empty()) continue;
                for (int row = area.first_row / size; row <= area.last_row / size; ++row) {
                    for (int column = area.first_column / size; column <= area.last_column / size;
                         ++column)
                        visit(static_cast<std::size_t>(row) * columns +
                                  static_cast<std::size_t>(column),
                              item, size * column, size * row);
                }
            }
        };
        ends_.assign(columns * count(height), 0);
        for_each_tile([&](std::size_t tile, std::size_t, int, int) { ++ends_[tile]; });
        tiles.clear();
        std::uint32_t listed = 0;
        for (std::size_t tile = 0; tile < ends_.size(); ++tile) {
            const std::uint32_t items = std::exchange(ends_[tile], listed);
            if (items == 0) continue;
            tiles.push_back({static_cast<std::uint32_t>(tile % columns * size),
                             static_cast<std::uint32_t>(tile / columns * size), listed,
                             listed + items});
            listed += items;
        }
        entries.resize(listed);
        for_each_tile([&](std::size_t tile, std::size_t item, int column, int row) {
            entries[ends_[tile]++] = entry(item, column, row);
        });
    }

  private:
    std::vector<std::uint32_t> ends_;  // of each tile's list
};

}  // namespace lamina
