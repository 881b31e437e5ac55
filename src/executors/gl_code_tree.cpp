// SPDX-License-Identifier: Apache-2.0
#include "executors/gl_code_tree.h"

namespace lamina {
namespace {

constexpr unsigned output_binding = 0, input_binding = 1;  // storage blocks

// Returns the plan with an emulation: nodes of other plans are rounded as the blending unit rounds.
CompositingPlan with_emulation(CompositingPlan plan) {
    if (!plan.emulation)
        plan.emulation =
            Emulation{plan.code_bits(), AlphaRounding::nearest, OverRounding::fused, 1};
    return plan;
}

}  // namespace

gl::Defines code_tree_defines(const CompositingPlan& plan) {
    gl::Defines defines;
    set_compositing(defines, with_emulation(plan));
    return defines;
}

GlCodeTree::GlCodeTree(const CompositingPlan& plan, const TreeShape& shape,
                       const glm::vec3& single_color, int width, int height)
    : GlTree(with_emulation(plan), shape),
      width_(width),
      height_(height),
      swizzle_("slicing/swizzle.comp", code_tree_defines(plan)),
      colorize_("slicing/colorize.comp", code_tree_defines(plan)) {
    for (int level = 0; level < shape_.levels(); ++level)
        images_.emplace_back(PixelPacking::bytes, width, height);
    swizzle_.set("swizzle", swizzle_unit);
    swizzle_.set("seed", static_cast<int>(plan_.emulation->seed));
    swizzle_.set("row_words", images_.front().row_words());
    colorize_.set("row_words", images_.front().row_words());
    colorize_.set("single_color", single_color);
}

void GlCodeTree::draw(CodeLeaves& leaves, const GlPixels& picture, Progress* progress) {
    leaves_ = &leaves;
    evaluate(progress);
    colorize_.set("picture_row", picture.row_words());
    picture.bind(output_binding, 0, height_);
    image(0).bind(input_binding, 0, height_);
    dispatch_pixels(colorize_, {0, 0, width_, height_});
}

void GlCodeTree::draw_leaf(int level, const SampleSpan& leaf, double depth_scale) {
    leaves_->draw(leaf, image(level), depth_scale);
}

void GlCodeTree::put_into_parent(int level, const SampleSpan& child, const SampleSpan& node) {
    bind_swizzle(child, node);
    swizzle_.set("stage", shape_.samples() + inserted_nodes_);
    image(level).bind(output_binding, 0, height_);
    image(level + 1).bind(input_binding, 0, height_);
    dispatch_pixels(swizzle_, {0, 0, width_, height_});
}

}  // namespace lamina
