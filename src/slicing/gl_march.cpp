// SPDX-License-Identifier: Apache-2.0
#include "slicing/gl_march.h"

#include <algorithm>

namespace lamina {
namespace {

constexpr unsigned queue_binding = 3;

// Workgroups that take tiles from a queue: more than any GPU runs at once, as those that begin late
// find the queue empty.
constexpr int most_groups = 4096;

}  // namespace

void set_rays(gl::Defines& defines, const RayDispatch& rays) {
    defines.set("GROUP", rays.group);
    if (rays.queue) defines.set("QUEUE", 1);
}

GlMarch::GlMarch(const GlSlabSource& source, const SlicePlan& plan) : source_(source), plan_(plan) {
    if (plan.rays.queue) next_tile_.emplace(sizeof(std::uint32_t));
}

int dispatches_of(const SlicePlan& plan, int slabs) {
    return slabs / plan.marched_slabs + (slabs % plan.marched_slabs != 0 ? 1 : 0);
}

void GlMarch::set_view(const View& view, const Slabs& slabs, Order order, gl::Program& program) {
    view_ = view;
    slabs_ = slabs;
    order_ = order;
    bricks_.clear();
    seen_ = {};
    set_visibility_order(plan_.bricks, source_.grid(), view, order, brick_order_);
    const double thickness = (slabs.far - slabs.near) / slabs.count;
    for (const std::size_t number : brick_order_) {
        const IndexBox box = source_.drawn_box(number);
        if (box.empty()) continue;
        const DepthRange depth = depth_range(source_.grid(), box, view);
        const double first = (depth.near - slabs.near) / thickness;
        const double end = (depth.far - slabs.near) / thickness;
        const PixelBox pixels = pixels_of(box, source_.grid(), view);
        seen_ = bricks_.empty() ? pixels : seen_.joined(pixels);
        bricks_.push_back({number, first - 1, end + 1});  // a slab more is far beyond rounding
    }
    source_.set_view(program, view, slabs);
}

const std::vector<GlMarch::Part>& GlMarch::parts_of(const SampleSpan& span) {
    parts_.clear();
    const int count = dispatches_of(plan_, span.count);
    for (const SeenBrick& brick : bricks_) {
        for (int i = 0; i < count; ++i) {
            const int place = order_ == Order::front_to_back ? i : count - 1 - i;
            const SampleSpan slabs = child_span(span, place, count);
            const bool last = &brick == &bricks_.back() && i + 1 == count;
            if (last || (slabs.first < brick.end_slab && slabs.end() > brick.first_slab))
                parts_.push_back({brick.number, slabs});
        }
    }
    return parts_;
}

DrawnPixels GlMarch::drawn_in(const RowBand& band) const {
    return {seen_.first_column, std::max(seen_.first_row, band.first_row), seen_.end_column,
            std::min(seen_.end_row, band.first_row + band.rows)};
}

void GlMarch::draw(const Part& part, const RowBand& band, gl::Program& program) {
    program.set("first_slab", static_cast<float>(part.slabs.first));
    program.set("slab_count", static_cast<float>(part.slabs.count));
    source_.set_brick(program, *view_, slabs_, part.brick);
    const DrawnPixels pixels = drawn_in(band);
    if (pixels.empty()) return;
    const glm::ivec2 tiles = set_pixels(program, pixels, plan_.rays.group);
    if (!plan_.rays.queue) {
        program.dispatch(tiles.x, tiles.y);
        return;
    }
    program.set("tile_columns", tiles.x);
    program.set("tile_count", tiles.x * tiles.y);
    next_tile_->clear();
    next_tile_->bind_storage(queue_binding);
    program.dispatch(std::min(tiles.x * tiles.y, most_groups));
}

}  // namespace lamina
