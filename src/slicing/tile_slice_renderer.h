// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <vector>

#include "base/progress.h"
#include "executors/tile_fixed_tree.h"
#include "lamina/image.h"
#include "slicing/slice_renderer.h"
#include "slicing/tile_march.h"
#include "slicing/tile_slab_source.h"
#include "tiles/tile_image.h"

namespace lamina {

// Draws a volume as the plan says, on the CPU. GlSliceRenderer draws it with OpenGL.
class TileSliceRenderer : public SliceRenderer {
  public:
    // Prepares the volume and the tables. `ready`: volume() of another renderer, which is used if
    // it has the right form.
    TileSliceRenderer(const Volume& volume, const TransferFunction& transfer_function,
                      const Facts& facts, const SlicePlan& plan, int width, int height,
                      std::shared_ptr<const TileVolume> ready = nullptr);
    TileSliceRenderer(const TileSliceRenderer&) = delete;  // its members refer to its plan
    TileSliceRenderer& operator=(const TileSliceRenderer&) = delete;

    bool take(const Plan& plan) override;
    // Draws a frame; its steps are tiles. It takes no memory after the first frame.
    void draw(const View& view, Progress* progress = nullptr) override;
    int step_count() const override { return source_ ? target_.grid().count() : 0; }
    using FrameRenderer::read;
    void read(Image& image) const override;
    std::map<std::string, double> stages_ms() const override;
    std::int64_t fragments() const override { return samples_; }

    SliceParts parts() const override { return {volume(), nullptr}; }
    std::shared_ptr<const TileVolume> volume() const { return source_ ? source_->volume() : kept_; }

    double upload_ms() const { return source_ ? source_->upload_ms() : 0; }
    double table_ms() const { return source_ ? source_->table_ms() : 0; }
    double geometry_ms() const { return geometry_ms_; }  // of the last frame
    double draw_ms() const { return draw_ms_; }
    std::int64_t samples() const { return samples_; }  // segments of rays in the last frame
    std::int64_t byte_count() const override;  // host memory that it takes, without the volume

  private:
    void clear_tile(int number);
    std::int64_t draw_tile(int number);

    SlicePlan plan_;
    Grid grid_;
    TileImage target_;
    std::vector<char> blank_;  // for each tile: it shows nothing
    TargetBlend blend_;
    std::optional<TileSlabSource> source_;  // empty if nothing is visible
    std::optional<TreeShape> shape_;
    std::optional<TileFixedTree> fixed_tree_;
    std::atomic<std::int64_t> samples_{0};
    std::shared_ptr<const TileVolume> kept_;  // kept for another renderer if this one needs none
    double geometry_ms_ = 0, draw_ms_ = 0;
};

}  // namespace lamina
