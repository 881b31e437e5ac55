// SPDX-License-Identifier: Apache-2.0
// Draws a frame of a volume on the CPU:
//   1. For each brick in visibility order: limit it to what is drawn of it, and set the pixels in
//      which it may show something.
//   2. For each tile of pixels, in parallel, for each brick in this order: step the rays through
//      slabs of equal thickness, or exactly from cell face to cell face (cpu_slabs.h).
//      a. Skip slabs, or cells, of empty bricks.
//      b. Composite the colour and opacity of the others onto the tile's pixels.
// With a compositing tree, step 2 draws the samples of each leaf, and the leaves are composited.
#include "slicing/slice_renderer.h"

#include <algorithm>
#include <functional>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <utility>

#include "base/parallel.h"
#include "base/profile.h"
#include "executors/lights.h"
#include "executors/transfer_tables.h"
#include "facts/drawn_range.h"
#include "optics/pieces.h"
#include "scene/camera.h"
#include "slicing/cpu_volume.h"
#include "slicing/gl_slice_renderer.h"

namespace lamina {
namespace {

// Length in voxels of the slabs that one test for emptiness covers; shorter runs gain little.
constexpr double tested_voxels = MinMaxBricks::edge / 4.0;

// Returns by how many voxels a slab is enlarged before it is tested for emptiness: 0.01, plus a
// bound on the rounding of a point in float32. This rounding is 1.2e-6 of the brick's size: four
// roundings of coordinates of at most five times the size, as in a block of slabs that begins in
// front of the box.
double point_margin(const TextureBrick& part) {
    const std::int64_t size = *std::ranges::max_element(part.size);
    return 0.01 + 2e-6 * static_cast<double>(size);
}

}  // namespace

CpuSliceRenderer::CpuSliceRenderer(const Volume& volume, const TransferFunction& transfer_function,
                                   const Facts& facts, const SlicePlan& plan, int width, int height,
                                   std::shared_ptr<const CpuVolume> ready)
    : plan_(plan),
      grid_(in_units(facts.grid, plan.unit)),
      target_(width, height),
      blank_(static_cast<std::size_t>(target_.grid().count())),
      blend_(target_blend(plan)),
      prepared_(!plan.nothing_visible),
      volume_(std::move(ready)) {
    if (!prepared_) return;
    prepare(volume, in_units(transfer_function, plan_.unit), facts);
    if (plan_.tree) shape_.emplace(plan_.tree->factors, plan_.slabs);
    if (plan_.has_tree(NodeArithmetic::fixed))
        fixed_tree_.emplace(plan_, *shape_, slabs_.single_color);
}

void CpuSliceRenderer::prepare(const Volume& volume, const TransferFunction& transfer_function,
                               const Facts& facts) {
    const ValueRange range = drawn_range(transfer_function, facts.range);
    const glm::dvec3 single = first_color(transfer_function, range.lo, range.hi);
    const OpticalProperties constant = transfer_function.at(range.lo);
    const bool sampled = plan_.sampling != VolumeSampling::none;
    const glm::dvec3 color = plan_.single_color || sampled ? single : constant.color;
    for (int channel = 0; channel < 3; ++channel)
        slabs_.single_color[static_cast<std::size_t>(channel)] = static_cast<float>(color[channel]);
    slabs_.constant_extinction = std::min(constant.extinction, max_shader_extinction);
    slabs_.plan = &plan_;
    occupied_ = facts.occupied_bricks;
    if (plan_.constant_regions) {
        constant_ = facts.constant_bricks;
        for (OpticalProperties& kind : constant_.kinds)
            kind.extinction = std::min(kind.extinction / plan_.unit, max_shader_extinction);
    }
    set_cells();
    slabs_.bricks.reserve(plan_.bricks.size());
    if (plan_.dither) {
        slabs_.alpha_ranks = dither_ranks(plan_.dither->period, plan_.dither->seed);
        slabs_.color_ranks =
            dither_ranks(plan_.dither->period, std::uint64_t{plan_.dither->seed} + 1);
    }
    if (!sampled) return;
    Stage tables("tables");
    const bool exact = plan_.integrates_cells();
    const ValueRange normalized_range =
        exact ? exact_range(transfer_function, facts.range, volume.type()) : range;
    transfer_.emplace(transfer_function, normalized_range,
                      plan_.uses_table() ? plan_.table.knot_table() : nullptr,
                      exact ? 0 : sampled_step_advance, plan_.curve_error > 0);
    slabs_.transfer = &*transfer_;
    table_ms_ = tables.end();
    if (!volume_ || !volume_->can_replace(volume, normalized_range, plan_)) {
        Stage upload("upload");
        volume_ = std::make_shared<CpuVolume>(volume, normalized_range, plan_);
        upload_ms_ = upload.end();
    }
    if (volume_->pages() != nullptr) {
        shown_pages_ = pages_shown(*volume_, occupied_, plan_.share);
        volume_->pages()->expect(shown_pages_);
    }
    if (!plan_.lighting) return;
    light_ = make_tile_light(*plan_.lighting, grid_.step, plan_.most_bend, faint_share_of_cells);
    slabs_.light = &*light_;
}

void CpuSliceRenderer::set_cells() {
    slabs_.occupied = plan_.occupied_only ? &occupied_ : nullptr;
    slabs_.constant = plan_.constant_regions ? &constant_ : nullptr;
    if (!plan_.integrates_cells()) return;
    if (slabs_.cells == nullptr || cells_leave_out_empty_ != plan_.occupied_only) {
        cells_ = make_cell_map(slabs_.occupied,
                               slabs_.constant != nullptr ? &slabs_.constant->varied : nullptr);
        cells_leave_out_empty_ = plan_.occupied_only;
    }
    slabs_.cells = &cells_;
    slabs_.occupied = nullptr;  // `cells` already contains both
    slabs_.constant = nullptr;
}

void CpuSliceRenderer::set_view(const View& view, const Slabs& slabs) {
    set_rays(view, slabs);
    slabs_.bricks.clear();
    seen_ = {};
    load_pages(view);
    if (plan_.bricks.size() == 1) {
        add_brick(0, view, slabs);
        return;
    }
    // A compositing tree in float always marches front to back, whatever order of slabs the plan
    // has.
    const Order order = plan_.has_tree(NodeArithmetic::shader) ? Order::front_to_back : plan_.order;
    set_visibility_order(plan_.bricks, grid_, view, order, order_);
    for (const std::size_t number : order_) add_brick(number, view, slabs);
}

// Reads pages that this view shows from disk in the files' order. If all fit the memory they are
// loaded now, on all cores; else they are announced, and read when a ray needs them.
void CpuSliceRenderer::load_pages(const View& view) const {
    if (!volume_ || volume_->pages() == nullptr) return;
    const BrickCache& cache = *volume_->pages();
    const std::vector<std::uint32_t> seen =
        pages_seen(shown_pages_, cache.count(), volume_->first_of_pages(), grid_, view);
    volume_->will_read(cache.missing(seen));
    if (cache.fits(seen.size())) cache.load_ahead(seen);
}

void CpuSliceRenderer::set_rays(const View& view, const Slabs& slabs) {
    CpuRays& rays = slabs_.rays;
    const bool perspective = view.projection == Projection::perspective;
    const glm::dvec3 column = grid_.direction_to_index(view.pixel * view.right);
    const glm::dvec3 row = grid_.direction_to_index(-view.pixel * view.up);
    const double spread = perspective ? slabs.near : 1;
    rays.origin_column = spread * column;
    rays.origin_row = spread * row;
    rays.direction_middle = grid_.direction_to_index(view.forward);
    rays.direction_column = perspective ? column : glm::dvec3(0);
    rays.direction_row = perspective ? row : glm::dvec3(0);
    rays.middle_column = 0.5 * view.width;
    rays.middle_row = 0.5 * view.height;
    rays.pixel_size = perspective ? static_cast<double>(static_cast<float>(view.pixel)) : 0.0;
    rays.slab_thickness = (slabs.far - slabs.near) / slabs.count;
    const double voxels = rays.slab_thickness * glm::length(rays.direction_middle);
    rays.tested_slabs =
        static_cast<int>(std::clamp(tested_voxels / voxels, 1.0, double{block_slabs}));
    for (std::size_t i = 0; i < rays.edges.size(); ++i)
        rays.edges[i] = static_cast<float>(static_cast<double>(i) * rays.slab_thickness);
    for (std::size_t i = 0; i < rays.middles.size(); ++i)
        rays.middles[i] = 0.5f * (rays.edges[i] + rays.edges[i + 1]);
}

void CpuSliceRenderer::add_brick(std::size_t number, const View& view, const Slabs& slabs) {
    const TextureBrick& part = plan_.bricks[number];
    const glm::dvec3 first{part.first[0], part.first[1], part.first[2]};
    const IndexBox box = box_of(part, grid_);
    CpuBrickView brick;
    brick.drawn = {glm::max(box.min, plan_.drawn.min), glm::min(box.max, plan_.drawn.max)};
    if (brick.drawn.empty()) return;
    if (volume_) brick.brick = volume_->bricks()[number];
    brick.origin_middle = grid_.to_index(view.eye + slabs.near * view.forward) - first;
    for (const IndexPlane& plane : plan_.clip) brick.clip.push_back(plane.seen_from(first));
    brick.first = first;
    brick.margin = point_margin(part);
    // The box is rounded to float, as shaders/slicing/ray.glsl gets it.
    brick.box = {glm::dvec3(glm::vec3(box.min - first)), glm::dvec3(glm::vec3(box.max - first))};
    brick.drawn.min -= first;
    brick.drawn.max -= first;
    if (plan_.share && !keep_to_share({plan_.share->min - first, plan_.share->max - first}, brick))
        return;
    brick.last_face = last_face_of(brick.box.max, first, grid_);
    slabs_.bricks.push_back(brick);
    add_visible_pixels(brick, view);
}

// Limits a brick to a renderer's share of the volume: exact segments are clipped to it, slabs keep
// it for their segments' middles. Returns false if nothing of the brick is left.
bool CpuSliceRenderer::keep_to_share(const IndexBox& share, CpuBrickView& brick) const {
    if (!plan_.integrates_cells()) {
        brick.share = share;
        return true;
    }
    for (IndexBox* const box : {&brick.box, &brick.drawn})
        *box = {glm::max(box->min, share.min), glm::min(box->max, share.max)};
    return !brick.drawn.empty();
}

void CpuSliceRenderer::add_visible_pixels(const CpuBrickView& brick, const View& view) {
    const auto pixels = [&](const glm::dvec3& min, const glm::dvec3& max) {
        return pixels_of({brick.first + min, brick.first + max}, grid_, view);
    };
    PixelBox seen = pixels(brick.drawn.min, brick.drawn.max);
    if (brick.share)
        seen = seen.common(pixels(glm::max(brick.box.min, brick.share->min),
                                  glm::min(brick.box.max, brick.share->max)));
    seen_ = slabs_.bricks.size() == 1 ? seen : seen_.joined(seen);
}

// If nothing was visible in the first plan, nothing was prepared, so the renderer accepts only
// plans in which nothing is visible.
bool CpuSliceRenderer::try_switch_to(const Plan& plan) {
    const SlicePlan& slice = plan.slice;
    if ((!prepared_ && !slice.nothing_visible) || of_all_views(slice) != of_all_views(plan_))
        return false;
    plan_ = slice;
    if (prepared_) set_cells();
    return true;
}

void CpuSliceRenderer::draw(const View& world_view, Progress* progress) {
    const View view = in_units(world_view, plan_.unit);
    samples_ = 0;
    geometry_ms_ = draw_ms_ = 0;
    const DepthRange depth = depth_range(grid_, view);
    if (!prepared_ || plan_.nothing_visible || depth.far <= depth.near) {
        for (int number = 0; number < target_.grid().count(); ++number) clear_tile(number);
        return;
    }
    Stage geometry("geometry");
    set_view(view, {depth.near, depth.far, plan_.slabs});
    geometry_ms_ = geometry.end();
    Stage drawing("draw");
    // Threads take tiles in order: if the volume stays on disk, neighbours need the same pages.
    std::atomic<int> next{0};
    parallel_for(target_.grid().count(), 1, [&](std::int64_t) {
        const int tile = next++;
        if (seen_.meets(target_.grid().tile(tile))) {
            samples_ += draw_tile(tile);
        } else {
            clear_tile(tile);
        }
        if (progress != nullptr) progress->advance();
    });
    drawing.count("samples", static_cast<double>(samples_));
    draw_ms_ = drawing.end();
    if (volume_) volume_->check_unchanged();
}

void CpuSliceRenderer::clear_tile(int number) {
    char& blank = blank_[static_cast<std::size_t>(number)];
    if (blank == 0) target_.tile(number) = TilePixels{};
    blank = 1;
}

std::int64_t CpuSliceRenderer::draw_tile(int number) {
    blank_[static_cast<std::size_t>(number)] = 0;
    const TileGrid::Tile area = target_.grid().tile(number);
    TilePixels& pixels = target_.tile(number);
    if (plan_.has_tree(NodeArithmetic::shader)) return march_tile(slabs_, *shape_, area, pixels);
    if (!fixed_tree_) return blend_tile(slabs_, blend_, area, pixels);
    std::int64_t samples = 0;
    const auto draw_leaf = [&](const SampleSpan& span, double depth_scale,
                               TilePixels::Plane& opacity) {
        samples += blend_tile_opacity(slabs_, blend_, area, span, depth_scale, opacity);
    };
    // std::ref, because a std::function of the lambda itself would allocate memory.
    fixed_tree_->draw(area, std::ref(draw_leaf), pixels);
    return samples;
}

void CpuSliceRenderer::read(Image& image) const {
    target_.read(blend_.largest, image);
}

std::int64_t CpuSliceRenderer::byte_count() const {
    if (!prepared_) return target_.byte_count();
    const std::size_t bricks = occupied_.distance.size() + constant_.kind.size() +
                               constant_.varied.distance.size() + cells_.kinds.size();
    return target_.byte_count() + static_cast<std::int64_t>(bricks) +
           (transfer_ ? transfer_->byte_count() : 0) + (volume_ ? volume_->byte_count() : 0) +
           (fixed_tree_ ? fixed_tree_->byte_count() : 0);
}

std::map<std::string, double> CpuSliceRenderer::stages_ms() const {
    return {{"tables", table_ms_},
            {"upload", upload_ms_},
            {"geometry", geometry_ms_},
            {"draw", draw_ms_}};
}

std::unique_ptr<SliceRenderer> make_slice_renderer(const Volume& volume,
                                                   const TransferFunction& transfer_function,
                                                   const Facts& facts, const SlicePlan& plan,
                                                   const Capabilities& capabilities, int width,
                                                   int height, const SliceReuse& ready) {
    if (capabilities.cpu) {
        return std::make_unique<CpuSliceRenderer>(volume, transfer_function, facts, plan, width,
                                                  height, ready.tiles);
    }
    return std::make_unique<GlSliceRenderer>(volume, transfer_function, facts, plan, capabilities,
                                             width, height, ready.textures);
}

}  // namespace lamina
