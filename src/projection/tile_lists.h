// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <tbb/task_arena.h>
#include "base/parallel.h"
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

    // `areas`: the pixels inside the picture that each item may cover; may be empty.
    // `entry(item, column, row)`: the entry of an item for the tile of this upper left pixel, on
    // any core. Returns the number of entries; lists them only if there are at most `most`.
    template <typename MakeEntry>
    std::size_t list(std::span<const PixelArea> areas, int width, int height, std::uint32_t most,
                     const MakeEntry& entry) {
        const std::size_t columns = count(width), places = columns * count(height);
        const auto items = std::ssize(areas);
        // Each part counts in all places, so it has as many items at least.
        const auto least = std::max(items_for_a_core, static_cast<std::int64_t>(places));
        const std::int64_t parts =
            std::clamp<std::int64_t>(items / least, 1, tbb::this_task_arena::max_concurrency());
        // Visits each tile of each item, and the place in ends_ of the tile in the item's part.
        const auto for_each_tile = [&](const auto& visit) {
            parallel_for(parts, 1, [&](std::int64_t part) {
                const std::span ends(ends_.data() + static_cast<std::size_t>(part) * places,
                                     places);
                const auto end = static_cast<std::size_t>((part + 1) * items / parts);
                for (auto item = static_cast<std::size_t>(part * items / parts); item < end; ++item)
                    visit_tiles(areas[item], [&](int column, int row) {
                        visit(ends[static_cast<std::size_t>(row) * columns +
                                   static_cast<std::size_t>(column)],
                              item, size * column, size * row);
                    });
            });
        };
        ends_.assign(static_cast<std::size_t>(parts) * places, 0);
        for_each_tile([](std::uint32_t& end, std::size_t, int, int) { ++end; });
        tiles.clear();
        std::size_t listed = 0;
        for (std::size_t tile = 0; tile < places; ++tile) {
            const std::size_t first = listed;
            for (std::size_t place = tile; place < ends_.size(); place += places)
                listed += std::exchange(ends_[place], static_cast<std::uint32_t>(listed));
            if (listed == first) continue;
            tiles.push_back({static_cast<std::uint32_t>(tile % columns * size),
                             static_cast<std::uint32_t>(tile / columns * size),
                             static_cast<std::uint32_t>(first),
                             static_cast<std::uint32_t>(listed)});
        }
        if (listed > most) {
            tiles.clear();
            return listed;
        }
        entries.resize(listed);
        for_each_tile([&](std::uint32_t& end, std::size_t item, int column, int row) {
            entries[end++] = entry(item, column, row);
        });
        return listed;
    }

  private:
    // Each core lists a part of the items. With fewer items than this for each, starting it would
    // take as long as listing them: 10 ns each.
    static constexpr std::int64_t items_for_a_core = 4096;

    // Visits the tiles of an area, by column and row.
    template <typename Visit>
    static void visit_tiles(const PixelArea& area, const Visit& visit) {
        if (area.empty()) return;
        for (int row = area.first_row / size; row <= area.last_row / size; ++row) {
            for (int column = area.first_column / size; column <= area.last_column / size; ++column)
                visit(column, row);
        }
    }

    // Ends of the lists: of each part, as long as it is listed, for each tile.
    std::vector<std::uint32_t> ends_;
};

}  // namespace lamina
