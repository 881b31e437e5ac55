// SPDX-License-Identifier: Apache-2.0
#include "slicing/gl_shader_tree.h"

#include <glad/gl.h>

#include <algorithm>

#include "base/client.h"
#include "base/error.h"
#include "gl/api.h"

namespace lamina {
namespace {

constexpr unsigned output_binding = 0, children_binding = 1, kept_binding = 1;  // storage blocks

// Limit in bytes on all nodes and sums; if the full height takes more, it is drawn in bands.
constexpr std::int64_t memory_budget = std::int64_t{1} << 28;

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

int largest_leaf(const TreeShape& shape) {
    SampleSpan node = shape.root();
    for (int level = 0; !shape.is_marched(level, node); ++level)
        node.count = (node.count + shape.factor(level) - 1) / shape.factor(level);
    return node.count;
}

// Tells whether leaves take several dispatches.
bool keeps_sums(const SlicePlan& plan) {
    const TreeShape shape(plan.tree->factors, plan.slabs);
    return plan.bricks.size() > 1 || dispatches_of(plan, largest_leaf(shape)) > 1;
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
    set_rays(segments, plan.rays);
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
      march_(source, plan),
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
    band_rows_ = rows_of_band(height_, (plan_.batches + leaf_count_ - 1) / leaf_count_, fitting);
    pace_.emplace(band_rows_, RowBand::tile_rows, !capabilities.software);
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
    march_.set_view(view, slabs, Order::front_to_back, *leaf_);
}

void GlShaderTree::draw(Progress* progress) {
    progress_ = progress;
    pace_->begin_frame();
    draw_bands(height_, *pace_, [&](const RowBand& band) {
        band_ = band;
        evaluate(0, shape_.root(), 0);
    });
    march_.end_frame();
}

void GlShaderTree::read(Image& image) const {
    picture_.read(image, packing_of(plan_) == PixelPacking::bytes ? 255 : 65535);
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
    dispatch_pixels(program, march_.drawn_in(band_));
}

void GlShaderTree::draw_leaf(const SampleSpan& leaf, int level, int place) {
    gl::Program& program = *leaf_;
    bind_output(program, level, place, leaf);
    source_.bind(program);
    if (kept_) {
        const int numbers = kept_numbers(plan_) * width_;
        kept_->bind_storage(kept_binding);
        program.set("kept_begin", -band_.first_row * numbers);
        program.set("kept_row", numbers);
    }
    const std::vector<GlMarch::Part>& parts = march_.parts_of(leaf);
    for (const GlMarch::Part& part : parts) {
        if (kept_) {
            program.set("first_dispatch", &part == &parts.front() ? 1 : 0);
            program.set("last_dispatch", &part == &parts.back() ? 1 : 0);
        }
        march_.draw(part, band_, program);
    }
    drawn_.end_step();
    if (progress_ != nullptr) progress_->advance(band_.rows);
    check_interrupt();
}

}  // namespace lamina
