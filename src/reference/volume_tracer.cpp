// SPDX-License-Identifier: Apache-2.0
#include "reference/volume_tracer.h"

#include <algorithm>
#include <glm/common.hpp>
#include <optional>
#include <vector>

#include "base/interrupt.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "reference/cell_walk.h"
#include "reference/chord.h"
#include "reference/gradient_samples.h"
#include "reference/ray_integrator.h"
#include "reference/transfer_intervals.h"
#include "reference/trilinear.h"
#include "reference/visible_blocks.h"

namespace lamina {
namespace {

// What all rays of a picture share.
template <typename Samples>
struct Traced {
    Traced(const Volume& volume, const Samples& first_sample, const TransferIntervals& intervals,
           const VisibleBlocks& visible_blocks, const TraceOptions& how)
        : grid(volume.grid()),
          samples(grid, first_sample),
          gradients(grid, first_sample),
          transfer(intervals),
          blocks(visible_blocks),
          options(how) {}

    const Grid& grid;
    CellSamples<Samples> samples;
    GradientSamples<Samples> gradients;
    const TransferIntervals& transfer;
    const VisibleBlocks& blocks;
    const TraceOptions& options;
};

// Adds the part of the chord inside one cell, from parameter `from` to `to`.
template <typename Samples>
void add_cell(const Traced<Samples>& traced, const Chord& chord, const CellIndex& cell, double from,
              double to, RayIntegrator& integrator) {
    const CellCorners corners = traced.samples.corners(cell);
    const auto [lo, hi] = corners.range();
    if (!traced.transfer.visible(lo, hi) || !CellSamples<Samples>::finite(corners)) return;
    const glm::dvec3 corner(cell[0], cell[1], cell[2]);
    const glm::dvec3 start =
        glm::clamp(chord.entry + from * chord.direction - corner, glm::dvec3(0), glm::dvec3(1));
    const glm::dvec3 step = (to - from) * chord.direction;
    const Cubic scalar = corners.along(start, step);
    const double length = (to - from) * chord.world_per_z;
    if (!traced.options.lighting) return integrator.add(scalar, lo, hi, length);
    const GradientAlong gradient = traced.gradients.along(cell, start, step);
    integrator.add_lit(scalar, gradient, lo, hi, length);
}

struct TracedRay {
    glm::dvec4 rgba{0};
    double error_estimate = 0;
    std::int64_t segments = 0;
};

template <typename Samples>
TracedRay trace_ray(const Traced<Samples>& traced, const View::Ray& ray) {
    const Chord chord = clip_to_box(traced.grid, ray, traced.options.clip);
    if (!(chord.length_z > 0)) return {};
    std::optional<RayLights> lights;
    if (traced.options.lighting) lights.emplace(*traced.options.lighting, -ray.direction);
    RayIntegrator integrator(traced.transfer, traced.options.tolerance, chord.world_length(),
                             lights ? &*lights : nullptr);
    const auto visit = [&](const CellIndex& cell, double from, double to) {
        add_cell(traced, chord, cell, from, to, integrator);
        return !integrator.opaque();
    };
    const auto hidden = [&](const CellIndex& cell, CellIndex& first, CellIndex& last) {
        return traced.blocks.hidden(cell, first, last);
    };
    CellWalk(traced.grid, chord).run(visit, hidden);
    return {glm::dvec4(integrator.color(), integrator.alpha()), integrator.error_estimate(),
            integrator.pieces()};
}

struct TileTotals {
    double error_estimate = 0;
    std::int64_t segments = 0;
};

template <typename Samples>
TileTotals trace_tile(const Traced<Samples>& traced, const View& view, const PictureTile& tile,
                      PreciseImage& image) {
    TileTotals totals;
    for (int row = tile.row; row < tile.row + tile.height; ++row) {
        check_interrupt();
        for (int column = tile.column; column < tile.column + tile.width; ++column) {
            const TracedRay ray = trace_ray(traced, view.ray(column, row));
            double* const pixel = image.pixel(column, row);
            for (int channel = 0; channel < 4; ++channel) pixel[channel] = ray.rgba[channel];
            totals.error_estimate = std::max(totals.error_estimate, ray.error_estimate);
            totals.segments += ray.segments;
        }
    }
    return totals;
}

// To find the blocks takes a look at every sample. That pays where rays meet as many cells: one
// through a cube meets about as many as an edge of it has, and rays through thin volumes fewer.
bool worth_blocks(const Volume& volume, const View& view) {
    const std::int64_t pixels = std::int64_t{view.width} * view.height;
    const std::int64_t cells_a_ray = std::ranges::min(volume.grid().size);
    return volume.in_memory() && volume.grid().sample_count() / cells_a_ray <= pixels;
}

}  // namespace

TraceResult trace_volume(const Volume& volume, const TransferFunction& transfer_function,
                         const View& view, const TraceOptions& options, const TileDone& tile_done) {
    check(options);
    TraceResult result{PreciseImage(view.width, view.height)};
    const TransferIntervals transfer(transfer_function);
    const VisibleBlocks blocks =
        worth_blocks(volume, view) ? VisibleBlocks(volume, transfer) : VisibleBlocks();
    const std::vector<PictureTile> tiles = tiles_to_trace(view.width, view.height);
    std::vector<TileTotals> totals(tiles.size());
    visit_samples(volume, [&](const auto& first_sample) {
        const Traced traced(volume, first_sample, transfer, blocks, options);
        const auto trace = [&](const PictureTile& tile, std::size_t number) {
            totals[number] = trace_tile(traced, view, tile, result.image);
        };
        trace_tiles(tiles, trace, result.image, tile_done);
    });
    check_unchanged(volume);
    for (const TileTotals& tile : totals) {
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
        const VisibleBlocks all;
        const Traced traced(volume, first_sample, transfer, all, options);
        parallel_for(static_cast<std::int64_t>(pixels.size()), 64, [&](std::int64_t number) {
            const auto i = static_cast<std::size_t>(number);
            rays[i] = trace_ray(traced, view.ray(pixels[i].x, pixels[i].y));
            progress.advance();
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
