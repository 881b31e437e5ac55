// SPDX-License-Identifier: Apache-2.0
#include "reference/volume_tracer.h"

#include <algorithm>
#include <array>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <optional>
#include <vector>

#include "base/interrupt.h"
#include "base/memory_limit.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "mesh/box_corners.h"
#include "reference/cell_batch.h"
#include "reference/cell_walk.h"
#include "reference/chord.h"
#include "reference/gradient_samples.h"
#include "reference/ray_integrator.h"
#include "reference/seen_pixels.h"
#include "reference/transfer_intervals.h"
#include "reference/trilinear.h"
#include "reference/visible_cells.h"

namespace lamina {
namespace {

// What all rays of a picture share.
template <typename Samples>
struct Traced {
    Traced(const Volume& volume, const Samples& first_sample, const TransferIntervals& intervals,
           const VisibleCells& visible_cells, const TraceOptions& how)
        : grid(volume.grid()),
          axes(grid),
          samples(grid, first_sample),
          gradients(grid, first_sample),
          transfer(intervals),
          cells(visible_cells),
          options(how) {
        // A share of the diagonal to spare, for axes that are not quite orthogonal (by 1e-5 at
        // most, volume_files/grid_check.cpp), and for rounding.
        const double spare =
            1e-4 * glm::distance(grid.to_world(axes.lowest), grid.to_world(axes.highest));
        glm::dvec3 steps;
        for (int axis = 0; axis < 3; ++axis)
            steps[axis] = spare / glm::length(grid.step[static_cast<std::size_t>(axis)]);
        corners = box_corners(axes.lowest - steps, axes.highest + steps);
        for (glm::dvec3& corner : corners) corner = grid.to_world(corner);
    }

    const Grid& grid;
    GridAxes axes;
    std::array<glm::dvec3, 8> corners;  // around the box, in the world
    CellSamples<Samples> samples;
    GradientSamples<Samples> gradients;
    const TransferIntervals& transfer;
    const VisibleCells& cells;
    const TraceOptions& options;
};

// The cells along one chord on their way to its integrator, some at a time: the first are few, in
// case that they hide the others.
template <typename Samples>
class ChordCells {
  public:
    ChordCells(const Traced<Samples>& traced, const Chord& chord, RayIntegrator& integrator)
        : traced_(traced), chord_(chord), integrator_(integrator) {}

    // Adds the part of the chord inside one cell, from parameter `from` to `to`. Returns whether
    // what follows is seen, as far as is known.
    bool add(const CellIndex& cell, double from, double to) {
        cells_.add(cell, from, to);
        if (cells_.count < together_) return true;
        flush();
        together_ = std::min(2 * together_, CellBatch::capacity);
        return !integrator_.opaque();
    }

    void flush() {
        traced_.samples.fetch(cells_);
        make_segments(cells_, chord_, traced_.transfer.columns(), segments_);
        if (traced_.options.lighting)
            integrator_.add_lit(segments_, [&](std::size_t segment) {
                return gradient(static_cast<std::size_t>(cells_.seen[segment]));
            });
        else
            integrator_.add(segments_);
        cells_.count = 0;
    }

  private:
    GradientAlong gradient(std::size_t number) const {
        const CellIndex cell{cells_.cell[0][number], cells_.cell[1][number],
                             cells_.cell[2][number]};
        const glm::dvec3 corner(cell[0], cell[1], cell[2]);
        const double from = cells_.from[number], to = cells_.to[number];
        return traced_.gradients.along(cell, chord_.place_in_cell(corner, from),
                                       (to - from) * chord_.direction);
    }

    const Traced<Samples>& traced_;
    const Chord& chord_;
    RayIntegrator& integrator_;
    std::size_t together_ = 8;
    CellBatch cells_;
    SegmentBatch segments_;
};

struct TracedRay {
    glm::dvec4 rgba{0};
    double error_estimate = 0;
    std::int64_t segments = 0;
};

template <typename Samples>
TracedRay trace_ray(const Traced<Samples>& traced, const View::Ray& ray,
                    RayIntegrator& integrator) {
    const Chord chord = clip_to_box(traced.axes, ray, traced.options.clip);
    if (!(chord.length_z > 0)) return {};
    std::optional<RayLights> lights;
    if (traced.options.lighting) lights.emplace(*traced.options.lighting, -ray.direction);
    integrator.begin(chord.world_length(), lights ? &*lights : nullptr);
    ChordCells<Samples> cells(traced, chord, integrator);
    const auto visit = [&](const CellIndex& cell, double from, double to, const CellBlock& block) {
        return !VisibleCells::may_show(block, cell) || cells.add(cell, from, to);
    };
    const auto block_of = [&](const CellIndex& cell) { return traced.cells.block_of(cell); };
    CellWalk(traced.grid, chord).run(visit, block_of);
    cells.flush();
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
    RayIntegrator integrator(traced.transfer, traced.options.tolerance);
    const SeenPixels around = TileSight(view, tile).around(traced.corners);
    for (int row = tile.row + around.first.y; row <= tile.row + around.last.y; ++row) {
        check_interrupt();
        for (int column = tile.column + around.first.x; column <= tile.column + around.last.x;
             ++column) {
            const TracedRay ray = trace_ray(traced, view.ray(column, row), integrator);
            double* const pixel = image.pixel(column, row);
            for (int channel = 0; channel < 4; ++channel) pixel[channel] = ray.rgba[channel];
            totals.error_estimate = std::max(totals.error_estimate, ray.error_estimate);
            totals.segments += ray.segments;
        }
    }
    return totals;
}

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
    std::vector<TileTotals> totals(tiles.size());
    visit_samples(volume, [&](const auto& first_sample) {
        const Traced traced(volume, first_sample, transfer, cells, options);
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
        const VisibleCells all;
        const Traced traced(volume, first_sample, transfer, all, options);
        constexpr std::size_t together = 64;
        const std::size_t parts = (pixels.size() + together - 1) / together;
        parallel_for(static_cast<std::int64_t>(parts), 1, [&](std::int64_t part) {
            const std::size_t first = static_cast<std::size_t>(part) * together;
            const std::size_t end = std::min(first + together, pixels.size());
            RayIntegrator integrator(transfer, options.tolerance);
            for (std::size_t i = first; i < end; ++i) {
                rays[i] = trace_ray(traced, view.ray(pixels[i].x, pixels[i].y), integrator);
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
