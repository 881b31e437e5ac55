// SPDX-License-Identifier: Apache-2.0
#include "slicing/gl_shader_tree.h"

#include <glad/gl.h>

#include <algorithm>

#include "base/client.h"
#include "base/error.h"
#include "executors/gl_compositing.h"
#include "gl/api.h"
#include "slicing/gl_slice_renderer.h"
#include "slicing/slab_geometry.h"

namespace lamina {
namespace {

constexpr int children_unit = 5, children_alpha_unit = 6, sum_unit = 7;

// Limit in bytes on all images; if the full height takes more, the picture is drawn in bands.
constexpr std::int64_t image_budget = std::int64_t{1} << 28;

// Tells whether an alpha code of 16 bits beside colours of 8 bits needs a texture of its own.
bool has_alpha_apart(const SlicePlan& plan) {
    return plan.target == Target::fixed8 && plan.tree->alpha_bits == 16;
}

gl::TextureFormat alpha_format(const SlicePlan& plan) {
    return has_alpha_apart(plan) ? gl::TextureFormat::r16 : opacity_format(plan);
}

std::int64_t bytes_per_layer_texel(const SlicePlan& plan) {
    if (plan.single_color) return info_of(alpha_format(plan)).bytes_per_texel;
    const int apart = has_alpha_apart(plan) ? 2 : 0;
    return info_of(color_format(plan)).bytes_per_texel + apart;
}

// Sets the definitions of shaders/slicing/node_output.glsl.
void set_node(gl::Defines& defines, const SlicePlan& plan, NodePlace place) {
    defines.set("NODE_CODE", static_cast<int>(plan.tree->code));
    if (place == NodePlace::root) defines.set("ROOT", 1);
    if (plan.single_color) {
        defines.set("MONOCHROME", 1);
    } else if (has_alpha_apart(plan)) {
        defines.set("ALPHA_APART", 1);
    }
}

}  // namespace

gl::Defines leaf_defines(const SlicePlan& plan, gl::Defines segments, NodePlace place) {
    set_node(segments, plan, place);
    if (plan.bricks.size() > 1) segments.set("ACCUMULATE", 1);
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
      height_(height) {
    std::int64_t layers = 0;
    int most_layers = 0;
    SampleSpan node = shape_.root();  // the largest node of its level
    std::vector<int> level_layers;
    for (int level = 0; !shape_.is_marched(level, node); ++level) {
        level_layers.push_back(std::min(shape_.factor(level), node.count));
        layers += level_layers.back();
        most_layers = std::max(most_layers, level_layers.back());
        node.count = (node.count + shape_.factor(level) - 1) / shape_.factor(level);
    }
    leaf_count_ = count_leaves(0, shape_.root());
    choose_bands(capabilities, layers, most_layers);
    for (const int count : level_layers) {
        LevelImages& images = images_.emplace_back();
        images.color = gl::Texture::make_2d_array(
            plan_.single_color ? alpha_format(plan_) : color_format(plan_), width_, band_rows_,
            count);
        if (!plan_.single_color && has_alpha_apart(plan_)) {
            images.alpha =
                gl::Texture::make_2d_array(alpha_format(plan_), width_, band_rows_, count);
        }
    }
    if (plan_.bricks.size() > 1) {
        sum_.emplace(gl::Texture::make_2d(gl::TextureFormat::rgba32f, width_, band_rows_));
    }
    make_programs();
}

int GlShaderTree::count_leaves(int level, const SampleSpan& node) const {
    if (shape_.is_marched(level, node)) return 1;
    int leaves = 0;
    for (int i = 0; i < shape_.factor(level); ++i)
        leaves += count_leaves(level + 1, child_span(node, i, shape_.factor(level)));
    return leaves;
}

void GlShaderTree::choose_bands(const Capabilities& capabilities, std::int64_t layers,
                                int most_layers) {
    if (most_layers > capabilities.max_array_layers) {
        fail(
            "render.slice.tree.factors: found a node with {} children, this OpenGL allows {} "
            "layers of a texture: {}",
            most_layers, capabilities.max_array_layers, capabilities.renderer);
    }
    const std::int64_t row_bytes = layers * width_ * bytes_per_layer_texel(plan_);
    const std::int64_t fitting =
        row_bytes > 0 ? std::max<std::int64_t>(image_budget / row_bytes, 1) : height_;
    const int wanted_bands = (plan_.batches + leaf_count_ - 1) / leaf_count_;
    band_rows_ = static_cast<int>(
        std::min<std::int64_t>(fitting, (height_ + wanted_bands - 1) / wanted_bands));
}

gl::Program GlShaderTree::make_program(const char* fragment, const gl::Defines& defines) {
    gl::Program program("gl/full_screen.vert", fragment, defines);
    program.set("single_color", source_.single_color());
    program.set("largest_color", static_cast<float>(plan_.tree->largest_color));
    return program;
}

void GlShaderTree::make_programs() {
    defines_ = leaf_defines(plan_, source_.defines(), leaf_place());
    leaf_.emplace("slicing/slab.vert", "slicing/leaf.frag", defines_);
    leaf_->set("largest_color", static_cast<float>(plan_.tree->largest_color));
    if (sum_) {
        encode_.emplace(make_program("slicing/encode.frag", node_defines(plan_, leaf_place())));
        encode_->set("sum", sum_unit);
    }
    if (images_.empty()) return;
    const auto make_node = [&](NodePlace place) {
        gl::Program program = make_program("slicing/node.frag", node_defines(plan_, place));
        program.set("children", children_unit);
        if (images_[0].alpha) program.set("children_alpha", children_alpha_unit);
        program.set("sample_share", 1.0f / static_cast<float>(shape_.samples()));
        return program;
    };
    root_node_.emplace(make_node(NodePlace::root));
    if (images_.size() > 1) node_.emplace(make_node(NodePlace::inner));
}

void GlShaderTree::take_plan() {
    if (leaf_defines(plan_, source_.defines(), leaf_place()) != defines_) make_programs();
}

void GlShaderTree::set_view(const View& view, const Slabs& slabs) {
    view_ = view;
    slabs_ = slabs;
    triangles_.clear();
    leaf_draws_.clear();
    set_visibility_order(plan_.bricks, source_.grid(), view, Order::front_to_back, bricks_);
    add_leaves(0, shape_.root());
    upload_vertices(triangles_, vertices_, vertex_array_);
    source_.set_view(*leaf_, view, slabs);
}

void GlShaderTree::add_leaves(int level, const SampleSpan& node) {
    if (!shape_.is_marched(level, node)) {
        for (int i = 0; i < shape_.factor(level); ++i) {
            add_leaves(level + 1, child_span(node, i, shape_.factor(level)));
        }
        return;
    }
    for (const std::size_t brick : bricks_) {
        const std::size_t first = triangles_.size();
        const IndexBox box = source_.drawn_box(brick);
        if (!box.empty()) {
            append_span_polygon(*view_, source_.grid(), box, slabs_, node, triangles_);
        }
        leaf_draws_.push_back({brick, first, triangles_.size()});
    }
}

void GlShaderTree::draw(gl::Framebuffer& target, Progress* progress) {
    target_ = &target;
    progress_ = progress;
    gl::api().Enable(GL_SCISSOR_TEST);
    for (int row = 0; row < height_; row += band_rows_) {
        band_ = {row, std::min(band_rows_, height_ - row)};
        next_leaf_ = 0;
        evaluate(0, shape_.root(), 0);
    }
    gl::api().Disable(GL_SCISSOR_TEST);
}

void GlShaderTree::bind_output(int level, int layer) {
    if (level == 0) {
        target_->bind();
        gl::api().Scissor(0, band_.first_row, width_, band_.rows);
        return;
    }
    const LevelImages& images = images_[static_cast<std::size_t>(level) - 1];
    if (images.alpha) {
        layer_.bind({&images.color, &*images.alpha}, layer);
    } else {
        layer_.bind({&images.color}, layer);
    }
    gl::api().Scissor(0, 0, width_, band_.rows);
    layer_.clear();
}

void GlShaderTree::evaluate(int level, const SampleSpan& node, int layer) {
    if (shape_.is_marched(level, node)) {
        draw_leaf(node, level, layer);
        return;
    }
    const int children = shape_.factor(level);
    for (int i = 0; i < children; ++i) evaluate(level + 1, child_span(node, i, children), i);
    bind_output(level, layer);
    const LevelImages& images = images_[static_cast<std::size_t>(level)];
    images.color.bind(children_unit);
    if (images.alpha) images.alpha->bind(children_alpha_unit);
    gl::Program& program = level == 0 ? *root_node_ : *node_;
    program.set("child_count", children);
    program.set("node_samples", node.count);
    if (level > 0) {
        program.set("node_share",
                    static_cast<float>(node.count) / static_cast<float>(shape_.samples()));
    }
    program.set("first_row", level == 0 ? band_.first_row : 0);
    gl::draw_full_screen(program, no_attributes_);
}

void GlShaderTree::draw_leaf(const SampleSpan& leaf, int level, int layer) {
    gl::Program& program = *leaf_;
    const float share = static_cast<float>(leaf.count) / static_cast<float>(shape_.samples());
    program.set("leaf_slabs", static_cast<float>(leaf.count));
    // Only the target has rows for all bands; other images have those of one band.
    const bool whole_rows = level == 0 && !sum_;
    const int first_row = whole_rows ? 0 : band_.first_row;
    program.set("image_middle",
                glm::vec2(0.5f * static_cast<float>(width_),
                          0.5f * static_cast<float>(height_) - static_cast<float>(first_row)));
    if (sum_) {
        sum_->bind();
        gl::api().Scissor(0, 0, width_, band_.rows);
        sum_->clear(glm::vec4(0));
        gl::api().Enable(GL_BLEND);
        gl::api().BlendFunc(GL_ONE_MINUS_DST_ALPHA, GL_ONE);
    } else {
        bind_output(level, layer);
        if (level > 0) program.set("node_share", share);
    }
    gl::api().Viewport(0, -first_row, width_, height_);
    march(program, next_leaf_++);
    if (sum_) {
        gl::api().Disable(GL_BLEND);
        bind_output(level, layer);
        sum_->color().bind(sum_unit);
        if (level > 0) encode_->set("node_share", share);
        encode_->set("first_row", level == 0 ? band_.first_row : 0);
        gl::draw_full_screen(*encode_, no_attributes_);
    }
    if (progress_ != nullptr) {
        gl::api().Finish();
        progress_->advance();
    }
    check_interrupt();
}

void GlShaderTree::march(gl::Program& program, std::size_t leaf) {
    source_.bind(program);
    program.use();
    vertex_array_.bind();
    for (std::size_t i = leaf * bricks_.size(); i < (leaf + 1) * bricks_.size(); ++i) {
        const LeafDraw& draw = leaf_draws_[i];
        if (draw.end_vertex == draw.first_vertex) continue;
        source_.set_brick(program, *view_, slabs_, draw.brick);
        gl::api().DrawArrays(GL_TRIANGLES, static_cast<int>(draw.first_vertex),
                             static_cast<int>(draw.end_vertex - draw.first_vertex));
    }
}

}  // namespace lamina
