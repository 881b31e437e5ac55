// SPDX-License-Identifier: Apache-2.0
#include "executors/gl_compositing.h"

#include <glad/gl.h>
#include <array>
#include <span>

#include "base/client.h"
#include "base/enum_words.h"
#include "executors/fixed_tree.h"
#include "gl/api.h"

namespace lamina {
namespace {

constexpr int swizzle_width = 256;  // entries in a row, as shaders/slicing/swizzle.glsl reads them

// Returns one of four formats: for float32, float16, codes of more than 8 bits, codes of up to 8.
gl::TextureFormat format_for(const CompositingPlan& plan,
                             const std::array<gl::TextureFormat, 4>& formats) {
    switch (plan.target) {
        case Target::float32:
            return formats[0];
        case Target::float16:
            return formats[1];
        case Target::fixed16:
        case Target::fixed8:
        case Target::emulated:
            return plan.code_bits() > 8 ? formats[2] : formats[3];
    }
    unreachable_enum();
}

// Uploads a table: for each code of a child, its opacity in the node as whole part and rest.
gl::Texture upload_swizzle(const Swizzle& swizzle) {
    const std::size_t codes = swizzle.whole.size();
    const int rows = static_cast<int>((codes + swizzle_width - 1) / swizzle_width);
    std::vector<float> texels(2 * static_cast<std::size_t>(rows) * swizzle_width);
    for (std::size_t code = 0; code < codes; ++code) {
        texels[2 * code] = swizzle.whole[code];
        texels[2 * code + 1] = swizzle.rest[code];
    }
    gl::Texture texture = gl::Texture::make_2d(gl::TextureFormat::rg32f, swizzle_width, rows);
    texture.upload({0, 0, 0, swizzle_width, rows, 1}, std::span<const float>(texels));
    return texture;
}

}  // namespace

gl::TextureFormat color_format(const CompositingPlan& plan) {
    using enum gl::TextureFormat;
    return format_for(plan, {rgba32f, rgba16f, rgba16, rgba8});
}

gl::TextureFormat opacity_format(const CompositingPlan& plan) {
    using enum gl::TextureFormat;
    return format_for(plan, {r32f, r16f, r16, r8});
}

void set_compositing(gl::Defines& defines, const CompositingPlan& plan) {
    defines.set("BITS", plan.code_bits());
    if (!plan.emulation) return;
    defines.set("EMULATED", 1);
    defines.set("ALPHA_ROUNDING", static_cast<int>(plan.emulation->alpha));
    if (plan.emulation->over == OverRounding::fused) defines.set("OVER_FUSED", 1);
    if (plan.order == Order::front_to_back) defines.set("FRONT_TO_BACK", 1);
}

CompositingState::CompositingState(const CompositingPlan& plan, bool opacity_only) {
    gl::api().Enable(GL_BLEND);
    if (plan.order == Order::back_to_front) {
        gl::api().BlendFunc(GL_ONE, opacity_only ? GL_ONE_MINUS_SRC_COLOR : GL_ONE_MINUS_SRC_ALPHA);
    } else {
        gl::api().BlendFunc(opacity_only ? GL_ONE_MINUS_DST_COLOR : GL_ONE_MINUS_DST_ALPHA, GL_ONE);
    }
}

CompositingState::~CompositingState() {
    gl::api().Disable(GL_BLEND);
}

GlTree::GlTree(const CompositingPlan& plan, const TreeShape& shape) : plan_(plan), shape_(shape) {
    for (const auto& [sizes, swizzle] : make_swizzles(shape_, plan.code_bits()))
        swizzles_.emplace(sizes, upload_swizzle(swizzle));
}

void GlTree::bind_swizzle(const SampleSpan& child, const SampleSpan& node) const {
    swizzles_.at({child.count, node.count}).bind(swizzle_unit);
}

void GlTree::evaluate(Progress* progress) {
    inserted_nodes_ = 0;
    evaluate(0, shape_.root(), progress);
}

void GlTree::evaluate(int level, const SampleSpan& node, Progress* progress) {
    clear(level);
    if (shape_.is_leaf(level, node)) {
        draw_leaf(level, node, static_cast<double>(shape_.samples()) / node.count);
        leaf_.end_step();
        if (progress != nullptr) progress->advance();
        check_interrupt();
        return;
    }
    const int children = shape_.factor(level);
    for (int i = 0; i < children; ++i) {
        const bool back_to_front = plan_.order == Order::back_to_front;
        const SampleSpan child = child_span(node, back_to_front ? children - 1 - i : i, children);
        if (child.count == 0) continue;
        evaluate(level + 1, child, progress);
        put_into_parent(level, child, node);
        ++inserted_nodes_;
    }
}

gl::Defines swizzle_defines(const CompositingPlan& plan) {
    return gl::Defines().set("BITS", plan.code_bits());
}

GlFixedTree::GlFixedTree(const CompositingPlan& plan, const TreeShape& shape,
                         const glm::vec3& single_color, int width, int height)
    : GlTree(plan, shape),
      swizzle_("gl/full_screen.vert", "slicing/swizzle.frag", swizzle_defines(plan)),
      colorize_("gl/full_screen.vert", "slicing/colorize.frag") {
    for (int level = 0; level < shape_.levels(); ++level)
        images_.emplace_back(gl::Texture::make_2d(opacity_format(plan), width, height));
    swizzle_.set("child", child_unit);
    swizzle_.set("swizzle", swizzle_unit);
    colorize_.set("root", child_unit);
    colorize_.set("single_color", single_color);
}

void GlFixedTree::draw(TreeLeaves& leaves, gl::Framebuffer& target, Progress* progress) {
    leaves_ = &leaves;
    evaluate(progress);
    target.bind();
    image(0).color().bind(child_unit);
    gl::draw_full_screen(colorize_, no_attributes_);
}

void GlFixedTree::draw_leaf(int level, const SampleSpan& leaf, double depth_scale) {
    image(level).bind();
    leaves_->draw(leaf, depth_scale);
}

void GlFixedTree::put_into_parent(int level, const SampleSpan& child, const SampleSpan& node) {
    image(level).bind();
    const CompositingState state(plan_, true);
    image(level + 1).color().bind(child_unit);
    bind_swizzle(child, node);
    gl::draw_full_screen(swizzle_, no_attributes_);
}

}  // namespace lamina
