// SPDX-License-Identifier: Apache-2.0
#include "slicing/gl_march.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <numeric>
#include <span>

namespace lamina {
namespace {

enum StorageBinding : unsigned { queue_binding = 3, order_binding = 5, cost_binding = 6 };

// Workgroups that take tiles from a queue: more than any GPU runs at once, as those that begin late
// find the queue empty.
constexpr int most_groups = 4096;

}  // namespace

void set_rays(gl::Defines& defines, const RayDispatch& rays) {
    defines.set("GROUP", rays.group);
    if (rays.queue) defines.set("QUEUE", 1);
    if (rays.sorted) defines.set("SORTED", 1);
}

// The upper left pixels of drawn tiles lie in different tiles of the whole picture, even if they
// are not the upper left ones there.
TilesByCost::TilesByCost(int width, int height, int group)
    : tile_(tile_size(group)),
      count_((glm::ivec2(width, height) + tile_ - 1) / tile_),
      cost_classes_(static_cast<std::size_t>(count_.x) * static_cast<std::size_t>(count_.y)) {
    costs_ = gl::Buffer::make_readable(cost_classes_.size() * sizeof(std::uint32_t));
    order_ = gl::Buffer(cost_classes_.size() * sizeof(std::uint32_t));
}

void TilesByCost::begin_frame() {
    listed_pixels_.reset();
    if (read_) classify(reading_.values<std::uint32_t>());
    costs_.clear();
}

// The largest costs are bounded by the median of drawn tiles, because one workgroup that had to
// wait would put all others into one class.
void TilesByCost::classify(std::span<const std::uint32_t> costs) {
    constexpr std::uint64_t most_medians = 8;
    std::vector<std::uint32_t> drawn;
    std::ranges::copy_if(costs, std::back_inserter(drawn), [](std::uint32_t c) { return c > 0; });
    if (drawn.empty()) return;
    const auto median = drawn.begin() + std::ssize(drawn) / 2;
    std::ranges::nth_element(drawn, median);
    const std::uint64_t largest =
        std::min<std::uint64_t>(std::ranges::max(drawn), most_medians * *median);
    for (std::size_t tile = 0; tile < costs.size(); ++tile) {
        const std::uint64_t below = largest - std::min<std::uint64_t>(costs[tile], largest);
        cost_classes_[tile] = static_cast<std::uint8_t>(below * (classes - 1) / largest);
    }
}

void TilesByCost::end_frame() {
    reading_.take(costs_);
    read_ = true;
}

std::size_t TilesByCost::class_of(const glm::ivec2& pixel) const {
    const glm::ivec2 place = pixel / tile_;
    return cost_classes_[static_cast<std::size_t>(place.y) * static_cast<std::size_t>(count_.x) +
                         static_cast<std::size_t>(place.x)];
}

void TilesByCost::list(const DrawnPixels& pixels) {
    const glm::ivec2 begin(pixels.first_column, pixels.first_row);
    const glm::ivec2 end(pixels.end_column, pixels.end_row);
    const auto visit = [&](const auto& visit_tile) {
        glm::ivec2 pixel, tile;
        for (pixel.y = begin.y, tile.y = 0; pixel.y < end.y; pixel.y += tile_.y, ++tile.y)
            for (pixel.x = begin.x, tile.x = 0; pixel.x < end.x; pixel.x += tile_.x, ++tile.x)
                visit_tile(class_of(pixel), tile);
    };
    std::array<std::size_t, classes> ends{};  // of each class in the list
    visit([&](std::size_t which, const glm::ivec2&) { ++ends[which]; });
    std::exclusive_scan(ends.begin(), ends.end(), ends.begin(), std::size_t{0});
    listed_.resize(cost_classes_.size());
    visit([&](std::size_t which, const glm::ivec2& tile) {
        listed_[ends[which]++] = static_cast<std::uint32_t>(tile.x | tile.y << 16);
    });
    order_.write(std::span(listed_).first(ends.back()));
    listed_pixels_ = pixels;
}

void TilesByCost::bind(const DrawnPixels& pixels, gl::Program& program) {
    if (listed_pixels_ != pixels) list(pixels);
    order_.bind_storage(order_binding);
    costs_.bind_storage(cost_binding);
    program.set("cost_columns", count_.x);
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
    if (plan_.rays.sorted && !by_cost_) by_cost_.emplace(view.width, view.height, plan_.rays.group);
    if (by_cost_) by_cost_->begin_frame();
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
    program.set("tile_columns", tiles.x);
    if (by_cost_) by_cost_->bind(pixels, program);
    if (!plan_.rays.queue) {
        program.dispatch(tiles.x, tiles.y);
        return;
    }
    program.set("tile_count", tiles.x * tiles.y);
    next_tile_->clear();
    next_tile_->bind_storage(queue_binding);
    program.dispatch(std::min(tiles.x * tiles.y, most_groups));
}

void GlMarch::end_frame() {
    if (by_cost_) by_cost_->end_frame();
}

}  // namespace lamina
