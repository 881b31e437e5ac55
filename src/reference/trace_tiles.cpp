// SPDX-License-Identifier: Apache-2.0
#include "reference/trace_tiles.h"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <mutex>

#include "base/parallel.h"
#include "base/progress.h"

namespace lamina {

std::vector<PictureTile> tiles_to_trace(int width, int height) {
    constexpr int edge = 32;
    std::vector<PictureTile> tiles;
    for (int row = 0; row < height; row += edge)
        for (int column = 0; column < width; column += edge)
            tiles.push_back(
                {column, row, std::min(edge, width - column), std::min(edge, height - row)});
    // Twice the distance of the middles, squared.
    const auto distance = [&](const PictureTile& tile) {
        const std::int64_t across = 2 * tile.column + tile.width - width;
        const std::int64_t down = 2 * tile.row + tile.height - height;
        return across * across + down * down;
    };
    std::ranges::stable_sort(tiles, {}, distance);
    return tiles;
}

void trace_tiles(const std::vector<PictureTile>& tiles,
                 const std::function<void(const PictureTile&, std::size_t, const RowDone&)>& trace,
                 const PreciseImage& picture, const TileDone& done) {
    std::int64_t rows = 0;
    for (const PictureTile& tile : tiles) rows += tile.height;
    Progress progress("tracing", rows);
    std::atomic<std::size_t> next{0};  // the loop's own numbers come in no order
    std::mutex telling;
    parallel_for(static_cast<std::int64_t>(tiles.size()), 1, [&](std::int64_t) {
        const std::size_t number = next++;
        // A tile of thousands of lit segments a ray takes minutes. Rows that show nothing are left
        // out.
        std::int64_t left = tiles[number].height;
        trace(tiles[number], number, [&] {
            if (left == 0) return;
            --left;
            progress.advance();
        });
        if (done) {
            const std::lock_guard lock(telling);
            done(tiles[number], picture);
        }
        progress.advance(left);
    });
}

}  // namespace lamina
