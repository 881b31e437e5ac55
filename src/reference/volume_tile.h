// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "lamina/image.h"
#include "reference/cell_walk.h"
#include "reference/chord.h"
#include "reference/tiles.h"
#include "reference/traced_ray.h"
#include "reference/traced_volume.h"
#include "reference/volume_ray.h"
#include "reference/volume_totals.h"
#include "scene/camera.h"
#include "simd/lane_set.h"

namespace lamina {

// Traces one tile of a volume's picture.
template <typename Samples>
class VolumeTile {
  public:
    VolumeTile(const TracedVolume<Samples>& traced, const View& view, const PictureTile& tile,
               PreciseImage& image, const RowDone& row_done)
        : traced_(traced),
          view_(view),
          image_(image),
          pixels_(pixels_of(tile, TileSight(view, tile).around(traced.corners), row_done)) {}

    VolumeTotals trace() {
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

    // Begins the next ray that meets the box, if there is one.
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

    // Clips the next rays where all that are clipped have begun. Returns whether one has not.
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

    // Goes on after a lane's cells are complete or its chord has ended.
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
        totals_.error_estimate = std::max(totals_.error_estimate, ray.error_estimate);
        totals_.segments += ray.segments;
    }

    const TracedVolume<Samples>& traced_;
    const View& view_;
    PreciseImage& image_;
    PixelsInTurn pixels_;
    CellLanes lanes_{};
    std::array<CellBatch*, width> batches_{};
    std::vector<VolumeRay<Samples>> rays_;  // one a lane
    std::array<glm::ivec2, width> pixel_of_{};
    // The next rays, of which some have begun.
    std::array<glm::ivec2, width> clipped_pixels_{};
    std::array<View::Ray, width> clipped_{};
    std::array<Chord, width> chords_;
    std::size_t clipped_count_ = 0, begun_ = 0;
    VolumeTotals totals_;
};

}  // namespace lamina
