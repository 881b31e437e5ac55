// SPDX-License-Identifier: Apache-2.0
#include "slicing/gl_shader_tree.h"

#include <glad/gl.h>

#include <algorithm>

#include "base/client.h"
#include "base/error.h"
#include "gl/api.h"
#include "slicing/slab_geometry.h"

namespace lamina {
namespace {

constexpr unsigned output_binding = 0, children_binding = 1, kept_binding = 1;  // storage blocks

// Limit in bytes on all nodes and sums; if the full height takes more, it is drawn in bands.
constexpr std::int64_t memory_budget = std::int64_t{1} << 28;

constexpr int tile_rows = 8;  // of shaders/gl/pixels.glsl

// Tells whether codes have 16 bits beside colours of 8 bits.
bool has_wide_code(const SlicePlan& plan) {
    return plan.target == Target::fixed8 && plan.tree->alpha_bits == 16;
}

// Returns the words of a node's pixel, as shaders/slicing/node_packing.glsl packs it.
int words_of_node(const SlicePlan& plan) {
    if (plan.single_color) return 1;
    return words_of(packing_of(plan)) + (has_wide_code(plan) ? 1 : 0);
}

// Returns the numbers that shaders/slicing/leaf.comp keeps of a ray.
int kept_numbers(const SlicePlan& plan) {
    return plan.single_color ? 1 : 5;
}

int parts_of_leaf(const SlicePlan& plan, int slabs) {
    return slabs / plan.marched_slabs + (slabs % plan.marched_slabs != 0 ? 1 : 0);
}

int largest_leaf(const TreeShape& shape) {
    SampleSpan node = shape.root();
    for (int level = 0; !shape.is_marched(level, node); ++level)
        node.count = (node.count + shape.factor(level) - 1) / shape.factor(level);
    return node.count;
}

// Tells whether leaves take several dispatches.
bool keeps_sums(const SlicePlan& plan) {
    const TreeShape shape(plan.tree->factors, plan.slabs);
    return plan.bricks.size() > 1 || parts_of_leaf(plan, largest_leaf(shape)) > 1;
}

// Sets the definitions of shaders/slicing/node_output.glsl.
void set_node(gl::Defines& defines, const SlicePlan& plan, NodePlace place) {
    defines.set("NODE_CODE", static_cast<int>(plan.tree->code));
    set_packing(defines, plan);
    if (place == NodePlace::root) defines.set("ROOT", 1);
    if (plan.single_color) defines.set("MONOCHROME", 1);
    if (has_wide_code(plan)) defines.set("WIDE_CODE", 1);
}

}  // namespace

gl::Defines leaf_defines(const SlicePlan& plan, gl::Defines segments, NodePlace place) {
    set_node(segments, plan, place);
    if (keeps_sums(plan)) segments.set("KEEPS_SUMS", 1);
    if (plan.occupied_only) {
        segments.set("OCCUPIED_ONLY", 1);
        segments.set("BRICK_EDGE", static_cast<int>(MinMaxBricks::edge));
    }
    if (plan.ends_early()) segments.set("ENDS_EARLY", 1);
    return segments;
}

gl::Defines node_defines(const SlicePlan& plan, NodePlace place) {
    gl::Defines defines;
    set_node(defines, plan, place);
    return defines;
}

GlShaderTree::GlShaderTree(const GlSlabSource& source, const SlicePlan& plan,
                           const Capabilities& capabilities, int width, int height)
    : source_(source),
      plan_(plan),
      shape_(plan.tree->factors, plan.slabs),
      width_(width),
      height_(height),
      picture_(packing_of(plan), width, height) {
    SampleSpan node = shape_.root();  // the largest node of its level
    std::vector<int> level_nodes;
    for (int level = 0; !shape_.is_marched(level, node); ++level) {
        level_nodes.push_back(std::min(shape_.factor(level), node.count));
        node.count = (node.count + shape_.factor(level) - 1) / shape_.factor(level);
    }
    leaf_count_ = count_leaves(0, shape_.root());
    choose_bands(capabilities, level_nodes);
    for (const int count : level_nodes)
        levels_.emplace_back(sizeof(std::uint32_t) *
                             static_cast<std::size_t>(count * node_words()));
    if (keeps_sums(plan_)) {
        kept_.emplace(sizeof(float) * static_cast<std::size_t>(kept_numbers(plan_)) *
                      static_cast<std::size_t>(width_) * static_cast<std::size_t>(band_rows_));
    }
    make_programs();
}

std::int64_t GlShaderTree::node_row_words() const {
    return std::int64_t{words_of_node(plan_)} * width_;
}

int GlShaderTree::count_leaves(int level, const SampleSpan& node) const {
    if (shape_.is_marched(level, node)) return 1;
    int leaves = 0;
    for (int i = 0; i < shape_.factor(level); ++i)
        leaves += count_leaves(level + 1, child_span(node, i, shape_.factor(level)));
    return leaves;
}

void GlShaderTree::choose_bands(const Capabilities& capabilities,
                                const std::vector<int>& level_nodes) {
    std::int64_t nodes = 0, most_nodes = 0;
    for (const std::int64_t count : level_nodes) {
        nodes += count;
        most_nodes = std::max(most_nodes, count);
    }
    const std::int64_t node_bytes = 4 * node_row_words();
    const std::int64_t kept_bytes = keeps_sums(plan_) ? 4 * kept_numbers(plan_) * width_ : 0;
    const std::int64_t row_bytes = std::max<std::int64_t>(nodes * node_bytes + kept_bytes, 1);
    const std::int64_t block_bytes =
        std::max({most_nodes * node_bytes, kept_bytes, 4 * std::int64_t{picture_.row_words()}});
    if (block_bytes > capabilities.max_storage_bytes) {
        fail(
            "render.slice.tree.factors: found a node with {} children, of which a row of {} pixels "
            "takes {} bytes; this OpenGL allows {}: {}",
            most_nodes, width_, block_bytes, capabilities.max_storage_bytes, capabilities.renderer);
    }
    const std::int64_t fitting = std::min(std::max<std::int64_t>(memory_budget / row_bytes, 1),
                                          capabilities.max_storage_bytes / block_bytes);
    const int wanted_bands = (plan_.batches + leaf_count_ - 1) / leaf_count_;
    const std::int64_t wanted = (height_ + wanted_bands - 1) / wanted_bands;
    const std::int64_t whole_tiles = (wanted + tile_rows - 1) / tile_rows * tile_rows;
    const bool has_tiles = fitting >= tile_rows;
    band_rows_ = static_cast<int>(std::min({has_tiles ? fitting / tile_rows * tile_rows : fitting,
                                            whole_tiles, std::int64_t{height_}}));
}

void GlShaderTree::make_programs() {
    const auto set_colors = [&](gl::Program& program) {
        program.set("single_color", source_.single_color());
        program.set("largest_color", static_cast<float>(plan_.tree->largest_color));
    };
    defines_ = leaf_defines(plan_, source_.defines(), leaf_place());
    leaf_.emplace("slicing/leaf.comp", defines_);
    set_colors(*leaf_);
    if (levels_.empty()) return;
    const auto make_node = [&](NodePlace place) {
        gl::Program program("slicing/node.comp", node_defines(plan_, place));
        set_colors(program);
        program.set("sample_share", 1.0f / static_cast<float>(shape_.samples()));
        return program;
    };
    root_node_.emplace(make_node(NodePlace::root));
    if (levels_.size() > 1) node_.emplace(make_node(NodePlace::inner));
}

void GlShaderTree::take_plan() {
    if (leaf_defines(plan_, source_.defines(), leaf_place()) != defines_) make_programs();
}

void GlShaderTree::set_view(const View& view, const Slabs& slabs) {
    view_ = view;
    slabs_ = slabs;
    bricks_.clear();
    seen_ = {};
    set_visibility_order(plan_.bricks, source_.grid(), view, Order::front_to_back, brick_order_);
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
    source_.set_view(*leaf_, view, slabs);
}

void GlShaderTree::draw(Progress* progress) {
    progress_ = progress;
    for (int row = 0; row < height_; row += band_rows_) {
        band_ = {row, std::min(band_rows_, height_ - row)};
        evaluate(0, shape_.root(), 0);
    }
}

void GlShaderTree::read(Image& image) const {
    picture_.read(image, packing_of(plan_) == PixelPacking::bytes ? 255 : 65535);
}

DrawnPixels GlShaderTree::drawn_of_band() const {
    return {seen_.first_column, std::max(seen_.first_row, band_.first_row), seen_.end_column,
            std::min(seen_.end_row, band_.first_row + band_.rows)};
}

void GlShaderTree::bind_output(gl::Program& program, int level, int place, const SampleSpan& node) {
    if (level == 0) {
        picture_.bind(output_binding, band_.first_row, band_.rows);
        program.set("output_begin", -band_.first_row * picture_.row_words());
        program.set("output_row", picture_.row_words());
        return;
    }
    levels_[static_cast<std::size_t>(level) - 1].bind_storage(output_binding);
    program.set("output_begin",
                static_cast<int>(place * node_words() - band_.first_row * node_row_words()));
    program.set("output_row", static_cast<int>(node_row_words()));
    program.set("node_share",
                static_cast<float>(node.count) / static_cast<float>(shape_.samples()));
}

void GlShaderTree::evaluate(int level, const SampleSpan& node, int place) {
    if (shape_.is_marched(level, node)) {
        draw_leaf(node, level, place);
        return;
    }
    const int children = shape_.factor(level);
    for (int i = 0; i < children; ++i) evaluate(level + 1, child_span(node, i, children), i);
    gl::Program& program = level == 0 ? *root_node_ : *node_;
    bind_output(program, level, place, node);
    levels_[static_cast<std::size_t>(level)].bind_storage(children_binding);
    program.set("children_begin", static_cast<int>(-band_.first_row * node_row_words()));
    program.set("children_row", static_cast<int>(node_row_words()));
    program.set("child_words", static_cast<int>(node_words()));
    program.set("child_count", children);
    program.set("node_samples", node.count);
    dispatch_pixels(program, drawn_of_band());
}

// A brick is drawn in the slabs that may show some of it. The last part is always drawn, because it
// writes the leaf.
void GlShaderTree::set_leaf_parts(const SampleSpan& leaf) {
    parts_.clear();
    const int count = parts_of_leaf(plan_, leaf.count);
    for (const SeenBrick& brick : bricks_) {
        for (int i = 0; i < count; ++i) {
            const SampleSpan slabs = child_span(leaf, i, count);
            const bool last = &brick == &bricks_.back() && i + 1 == count;
            if (last || (slabs.first < brick.end_slab && slabs.end() > brick.first_slab))
                parts_.push_back({brick.number, slabs});
        }
    }
}

void GlShaderTree::draw_leaf(const SampleSpan& leaf, int level, int place) {
    set_leaf_parts(leaf);
    bind_output(*leaf_, level, place, leaf);
    source_.bind(*leaf_);
    if (kept_) {
        const int numbers = kept_numbers(plan_) * width_;
        kept_->bind_storage(kept_binding);
        leaf_->set("kept_begin", -band_.first_row * numbers);
        leaf_->set("kept_row", numbers);
    }
    for (const LeafPart& part : parts_) draw_part(part);
    if (progress_ != nullptr) {
        gl::api().Finish();
        progress_->advance();
    }
    check_interrupt();
}

void GlShaderTree::draw_part(const LeafPart& part) {
    if (kept_) {
        leaf_->set("first_dispatch", &part == &parts_.front() ? 1 : 0);
        leaf_->set("last_dispatch", &part == &parts_.back() ? 1 : 0);
    }
    leaf_->set("first_slab", static_cast<float>(part.slabs.first));
    leaf_->set("slab_count", static_cast<float>(part.slabs.count));
    source_.set_brick(*leaf_, *view_, slabs_, part.brick);
    dispatch_pixels(*leaf_, drawn_of_band());
}

}  // namespace lamina
