// SPDX-License-Identifier: Apache-2.0
// The rays of a volume's picture:
//   for each ray of a tile:
//       chord = the part of the ray in the box and in the clip (chord.h)
//       for each cell along the chord (cell_walk.h), a batch of cells at a time:
//           fetch the samples, and make segments of the visible cells (cells.h)
//           composite the segments (composite.h); end if everything behind is hidden
// If VisibleCells are known, rays walk side by side, one a lane; as one ends, the next begins.
#include "reference/tracer.h"

#include "base/client.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "mesh/predicates.h"
#include "optics/ray_lights.h"
#include "reference/cell_walk.h"
#include "reference/cells.h"
#include "reference/chord.h"
#include "reference/composite.h"
#include "reference/transfer_intervals.h"
#include "simd/lane_set.h"

namespace lamina {
namespace {

struct TracedRay : TraceTotals {
    glm::dvec4 rgba{0};  // associated
};

// Data that all rays of a picture share. `Samples` are as in CellSamples.
template <typename Samples>
struct TracedVolume {
    TracedVolume(const Volume& volume, const Samples& first_sample,
                 const TransferIntervals& intervals, const VisibleCells& visible_cells,
                 const TraceOptions& how)
        : grid(volume.grid()),
          axes(grid),
          samples(grid, first_sample),
          gradients(grid, first_sample),
          transfer(intervals),
          visible(visible_cells),
          options(how) {
        // A margin for axes not quite orthogonal (by 1e-5, volume_files/volume_opening.cpp).
        const double spare =
            1e-4 * glm::distance(grid.to_world(axes.lowest), grid.to_world(axes.highest));
        glm::dvec3 steps;
        for (int axis = 0; axis < 3; ++axis) steps[axis] = spare / glm::length(grid.step[axis]);
        corners = box_corners(axes.lowest - steps, axes.highest + steps);
        for (glm::dvec3& corner : corners) corner = grid.to_world(corner);
    }

    const Grid& grid;
    GridAxes axes;
    std::array<glm::dvec3, 8> corners;  // corners of a box around the volume, in world space
    CellSamples<Samples> samples;
    GradientSamples<Samples> gradients;
    const TransferIntervals& transfer;
    const VisibleCells& visible;  // empty if they are not known
    const TraceOptions& options;
};

// Traces one ray at a time. The first batch of cells is small, because these may hide the others.
template <typename Samples>
class VolumeRay {
  public:
    explicit VolumeRay(const TracedVolume<Samples>& traced)
        : traced_(traced), integrator_(traced.transfer, traced.options.tolerance) {}

    // Begins a ray; its chord must not be empty.
    void begin(const View::Ray& ray, const Chord& chord) {
        chord_ = chord;
        lights_.reset();
        if (traced_.options.lighting) lights_.emplace(*traced_.options.lighting, -ray.direction);
        integrator_.begin(chord.world_length(), lights_ ? &*lights_ : nullptr);
        cells_.wanted = first_together;
    }

    // Returns the batch to which the caller adds cells in order. When complete(): integrate().
    CellBatch& cells() { return cells_; }

    // Composites the cells of the batch. Returns whether anything behind them may be visible.
    bool integrate() {
        traced_.samples.fetch(cells_);
        make_segments(cells_, chord_, traced_.transfer.columns(), segments_);
        if (traced_.options.lighting)
            integrator_.add(segments_, [&](std::size_t segment) {
                return gradient(static_cast<std::size_t>(segments_.cell[segment]));
            });
        else
            integrator_.add(segments_);
        cells_.count = 0;
        cells_.wanted = std::min(2 * cells_.wanted, CellBatch::capacity);
        return !integrator_.opaque();
    }

    TracedRay finish() {
        integrate();
        const glm::dvec4 rgba(integrator_.color(), integrator_.alpha());
        return {{integrator_.error_estimate(), integrator_.pieces()}, rgba};
    }

    TracedRay trace(const View::Ray& ray) {
        const Chord chord = clip_to_box(traced_.axes, ray, traced_.options.clip);
        if (!(chord.length_z > 0)) return {};
        begin(ray, chord);
        CellWalk(traced_.grid, chord_).run([&](const CellIndex& cell, double from, double to) {
            cells_.add(cell, from, to);
            return !cells_.complete() || integrate();
        });
        return finish();
    }

  private:
    static constexpr std::size_t first_together = 8;  // cells in a ray's first batch

    GradientAlong gradient(std::size_t number) const {
        const CellIndex cell{cells_.cell[0][number], cells_.cell[1][number],
                             cells_.cell[2][number]};
        const glm::dvec3 corner(cell[0], cell[1], cell[2]);
        const double from = cells_.from[number], to = cells_.to[number];
        return traced_.gradients.along(cell, chord_.place_in_cell(corner, from),
                                       (to - from) * chord_.direction);
    }

    const TracedVolume<Samples>& traced_;
    Chord chord_;
    std::optional<RayLights> lights_;
    RayIntegrator integrator_;
    CellBatch cells_;
    SegmentBatch segments_;
};

template <typename Samples>
class VolumeTile {
  public:
    VolumeTile(const TracedVolume<Samples>& traced, const View& view, const PictureTile& tile,
               PreciseImage& image, const RowDone& row_done)
        : traced_(traced),
          view_(view),
          image_(image),
          pixels_(pixels_of(tile, TileSight(view, tile).around(traced.corners), row_done)) {}

    TraceTotals trace() {
        if (!pixels_.any()) return {};
        if (traced_.visible.empty()) {
            trace_one_by_one();
        } else {
            trace_side_by_side();
        }
        return totals_;
    }

  private:
    static constexpr std::size_t width = CellLanes::width;

    static PixelsInTurn pixels_of(const PictureTile& tile, const SeenPixels& seen,
                                  const RowDone& row_done) {
        const glm::ivec2 first(tile.column, tile.row);
        return {first + seen.first, first + seen.last, row_done};
    }

    void trace_one_by_one() {
        VolumeRay ray(traced_);
        while (pixels_.any()) {
            const glm::ivec2 pixel = pixels_.take();
            add(pixel, ray.trace(view_.ray(pixel.x, pixel.y)));
        }
    }

    void trace_side_by_side() {
        rays_.reserve(width);
        while (rays_.size() < width) {
            rays_.emplace_back(traced_);
            batches_[rays_.size() - 1] = &rays_.back().cells();
        }
        for (std::size_t lane = 0; lane < width; ++lane) begin(lane);
        while (lanes_.walking != 0) {
            for_each_lane(walk_cells(lanes_, traced_.visible, batches_),
                          [&](std::size_t lane) { go_on(lane); });
        }
    }

    // Begins in a lane the next ray that meets the box, if there is one.
    void begin(std::size_t lane) {
        while (clip_next()) {
            const std::size_t next = begun_++;
            if (!(chords_[next].length_z > 0)) continue;
            pixel_of_[lane] = clipped_pixels_[next];
            rays_[lane].begin(clipped_[next], chords_[next]);
            enter_cells(lanes_, lane, traced_.axes, chords_[next]);
            return;
        }
    }

    // Clips the next rays if all clipped ones have begun. Returns whether one has not begun.
    bool clip_next() {
        if (begun_ < clipped_count_) return true;
        begun_ = clipped_count_ = 0;
        for (; clipped_count_ < width && pixels_.any(); ++clipped_count_) {
            const glm::ivec2 pixel = pixels_.take();
            clipped_pixels_[clipped_count_] = pixel;
            clipped_[clipped_count_] = view_.ray(pixel.x, pixel.y);
        }
        clip_to_box(traced_.axes, std::span(clipped_).first(clipped_count_), traced_.options.clip,
                    std::span(chords_).first(clipped_count_));
        return clipped_count_ > 0;
    }

    // Integrates a lane's batch. Ends the ray if all behind is hidden or its chord has ended.
    void go_on(std::size_t lane) {
        const bool walks = (lanes_.walking & lane_bit(lane)) != 0;
        if (walks && rays_[lane].integrate()) return;
        lanes_.stop(lane);
        add(pixel_of_[lane], rays_[lane].finish());
        begin(lane);
    }

    void add(const glm::ivec2& pixel, const TracedRay& ray) {
        for (int channel = 0; channel < 4; ++channel)
            image_.pixel(pixel.x, pixel.y)[channel] = ray.rgba[channel];
        totals_.add(ray);
    }

    const TracedVolume<Samples>& traced_;
    const View& view_;
    PreciseImage& image_;
    PixelsInTurn pixels_;
    CellLanes lanes_{};
    std::array<CellBatch*, width> batches_{};
    std::vector<VolumeRay<Samples>> rays_;  // one a lane
    std::array<glm::ivec2, width> pixel_of_{};
    // Rays that are clipped; the first begun_ of them have begun.
    std::array<glm::ivec2, width> clipped_pixels_{};
    std::array<View::Ray, width> clipped_{};
    std::array<Chord, width> chords_;
    std::size_t clipped_count_ = 0, begun_ = 0;
    TraceTotals totals_;
};

// Tells whether VisibleCells pay, which read every sample: if the rays meet at least as many cells
// as there are samples. A ray is taken to meet as many cells as the shortest edge has samples.
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
    const TransferIntervals transfer(transfer_function);
    const VisibleCells cells =
        worth_visible_cells(volume, view) ? VisibleCells(volume, transfer) : VisibleCells();
    TraceResult result;
    visit_samples(volume, [&](const auto& first_sample) {
        const TracedVolume traced(volume, first_sample, transfer, cells, options);
        const auto trace = [&](const PictureTile& tile, PreciseImage& image,
                               const RowDone& row_done) {
            return VolumeTile(traced, view, tile, image, row_done).trace();
        };
        result = trace_tiles(view, trace, tile_done);
    });
    check_unchanged(volume);
    return result;
}

TracedPixels trace_pixels(const Volume& volume, const TransferFunction& transfer_function,
                          const View& view, std::span<const glm::ivec2> pixels,
                          const TraceOptions& options) {
    check(options);
    const TransferIntervals transfer(transfer_function);
    std::vector<TracedRay> rays(pixels.size());
    Progress progress("tracing trial rays", std::ssize(pixels));
    visit_samples(volume, [&](const auto& first_sample) {
        const VisibleCells all;
        const TracedVolume traced(volume, first_sample, transfer, all, options);
        constexpr std::size_t together = 64;  // rays of one task
        const std::size_t batches = (pixels.size() + together - 1) / together;
        parallel_for(static_cast<std::int64_t>(batches), 1, [&](std::int64_t batch) {
            const std::size_t first = static_cast<std::size_t>(batch) * together;
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
