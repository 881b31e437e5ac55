// SPDX-License-Identifier: Apache-2.0
#include "reference/volume_tracer.h"

#include <algorithm>
#include <glm/vec2.hpp>
#include <vector>

#include "base/memory_limit.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "reference/traced_volume.h"
#include "reference/transfer_intervals.h"
#include "reference/visible_cells.h"
#include "reference/volume_ray.h"
#include "reference/volume_tile.h"

namespace lamina {
namespace {

// To find them takes a look at every sample. That pays where rays meet as many cells: one
// through a cube meets about as many as an edge of it has, and rays through thin volumes fewer.
bool worth_visible_cells(const Volume& volume, const View& view) {
    const std::int64_t pixels = std::int64_t{view.width} * view.height;
    const std::int64_t cells_a_ray = std::ranges::min(volume.grid().size);
    return volume.in_memory() && volume.grid().sample_count() / cells_a_ray <= pixels &&
           VisibleCells::bytes_for(volume.grid()) <= memory_left();
}

}  // namespace

TraceResult trace_volume(const Volume& volume, const TransferFunction& transfer_function,
                         const View& view, const TraceOptions& options, const TileDone& tile_done) {
    check(options);
    TraceResult result{PreciseImage(view.width, view.height)};
    const TransferIntervals transfer(transfer_function);
    const VisibleCells cells =
        worth_visible_cells(volume, view) ? VisibleCells(volume, transfer) : VisibleCells();
    const std::vector<PictureTile> tiles = tiles_to_trace(view.width, view.height);
    std::vector<VolumeTotals> totals(tiles.size());
    visit_samples(volume, [&](const auto& first_sample) {
        const TracedVolume traced(volume, first_sample, transfer, cells, options);
        const auto trace = [&](const PictureTile& tile, std::size_t number,
                               const RowDone& row_done) {
            totals[number] = VolumeTile(traced, view, tile, result.image, row_done).trace();
        };
        trace_tiles(tiles, trace, result.image, tile_done);
    });
    check_unchanged(volume);
    for (const VolumeTotals& tile : totals) {
        result.error_estimate = std::max(result.error_estimate, tile.error_estimate);
        result.segments += tile.segments;
    }
    return result;
}

TracedPixels trace_pixels(const Volume& volume, const TransferFunction& transfer_function,
                          const View& view, std::span<const glm::ivec2> pixels,
                          const TraceOptions& options) {
    check(options);
    const TransferIntervals transfer(transfer_function);
    std::vector<TracedRay> rays(pixels.size());
    Progress progress("tracing trial rays", static_cast<std::int64_t>(pixels.size()));
    visit_samples(volume, [&](const auto& first_sample) {
        const VisibleCells all;
        const TracedVolume traced(volume, first_sample, transfer, all, options);
        constexpr std::size_t together = 64;
        const std::size_t parts = (pixels.size() + together - 1) / together;
        parallel_for(static_cast<std::int64_t>(parts), 1, [&](std::int64_t part) {
            const std::size_t first = static_cast<std::size_t>(part) * together;
            const std::size_t end = std::min(first + together, pixels.size());
            VolumeRay ray(traced);
            for (std::size_t i = first; i < end; ++i) {
                rays[i] = ray.trace(view.ray(pixels[i].x, pixels[i].y));
                progress.advance();
            }
        });
    });
    TracedPixels traced;
    for (const TracedRay& ray : rays) {
        traced.rgba.push_back(ray.rgba);
        traced.error_estimate = std::max(traced.error_estimate, ray.error_estimate);
    }
    return traced;
}

}  // namespace lamina
