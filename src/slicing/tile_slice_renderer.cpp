// SPDX-License-Identifier: Apache-2.0
#include "slicing/tile_slice_renderer.h"

#include <atomic>
#include <utility>

#include "base/parallel.h"
#include "base/profile.h"
#include "facts/world_unit.h"

namespace lamina {
namespace {

class SlabLeaves : public TileLeaves {
  public:
    SlabLeaves(const TileSlabs& slabs, const TargetBlend& blend, const TileGrid::Tile& area)
        : slabs_(slabs), blend_(blend), area_(area) {}

    void draw(const SampleSpan& span, double depth_scale, TilePixels::Plane& opacity) override {
        samples_ += blend_tile_opacity(slabs_, blend_, area_, span, depth_scale, opacity);
    }
    std::int64_t samples() const { return samples_; }

  private:
    const TileSlabs& slabs_;
    const TargetBlend& blend_;
    const TileGrid::Tile& area_;
    std::int64_t samples_ = 0;
};

}  // namespace

TileSliceRenderer::TileSliceRenderer(const Volume& volume,
                                     const TransferFunction& transfer_function, const Facts& facts,
                                     const SlicePlan& plan, int width, int height,
                                     std::shared_ptr<const TileVolume> ready)
    : plan_(plan),
      grid_(in_units(facts.grid, plan.unit)),
      target_(width, height),
      blank_(static_cast<std::size_t>(target_.grid().count())),
      blend_(target_blend(plan)) {
    if (plan_.nothing_visible) {
        kept_ = std::move(ready);
        return;
    }
    source_.emplace(volume, in_units(transfer_function, plan_.unit), facts, plan_,
                    std::move(ready));
    if (plan_.tree) shape_.emplace(plan_.tree->factors, plan_.slabs);
    if (plan_.has_tree(NodeArithmetic::fixed))
        fixed_tree_.emplace(plan_, *shape_, source_->slabs().single_color);
}

// Nothing was made if nothing was visible.
bool TileSliceRenderer::take(const Plan& plan) {
    const SlicePlan& slice = plan.slice;
    if ((!source_ && !slice.nothing_visible) || of_all_views(slice) != of_all_views(plan_))
        return false;
    plan_ = slice;
    if (source_) source_->take_plan();
    return true;
}

void TileSliceRenderer::draw(const View& world_view, Progress* progress) {
    const View view = in_units(world_view, plan_.unit);
    samples_ = 0;
    geometry_ms_ = draw_ms_ = 0;
    const DepthRange depth = depth_range(grid_, view);
    if (!source_ || plan_.nothing_visible || depth.far <= depth.near) {
        for (int number = 0; number < target_.grid().count(); ++number) clear_tile(number);
        return;
    }
    Stage geometry("geometry");
    source_->set_view(view, {depth.near, depth.far, plan_.slabs});
    geometry_ms_ = geometry.end();
    Stage drawing("draw");
    // Tiles are taken one after the other, by whichever thread: in a volume that stays in its
    // files, neighbours need the same pages.
    std::atomic<int> next{0};
    parallel_for(target_.grid().count(), 1, [&](std::int64_t) {
        const int tile = next++;
        if (source_->seen().meets(target_.grid().tile(tile))) {
            samples_ += draw_tile(tile);
        } else {
            clear_tile(tile);
        }
        if (progress != nullptr) progress->advance();
    });
    drawing.count("samples", static_cast<double>(samples_));
    draw_ms_ = drawing.end();
    source_->check_unchanged();
}

void TileSliceRenderer::clear_tile(int number) {
    char& blank = blank_[static_cast<std::size_t>(number)];
    if (blank == 0) target_.tile(number) = TilePixels{};
    blank = 1;
}

std::int64_t TileSliceRenderer::draw_tile(int number) {
    blank_[static_cast<std::size_t>(number)] = 0;
    const TileGrid::Tile area = target_.grid().tile(number);
    TilePixels& pixels = target_.tile(number);
    if (plan_.has_tree(NodeArithmetic::shader))
        return march_tile(source_->slabs(), *shape_, area, pixels);
    if (!fixed_tree_) return blend_tile(source_->slabs(), blend_, area, pixels);
    SlabLeaves leaves(source_->slabs(), blend_, area);
    fixed_tree_->draw(area, leaves, pixels);
    return leaves.samples();
}

void TileSliceRenderer::read(Image& image) const {
    target_.read(blend_.largest, image);
}

std::int64_t TileSliceRenderer::byte_count() const {
    return target_.byte_count() + (source_ ? source_->byte_count() : 0) +
           (fixed_tree_ ? fixed_tree_->byte_count() : 0);
}

std::map<std::string, double> TileSliceRenderer::stages_ms() const {
    return {{"tables", table_ms()},
            {"upload", upload_ms()},
            {"geometry", geometry_ms()},
            {"draw", draw_ms()}};
}

}  // namespace lamina
