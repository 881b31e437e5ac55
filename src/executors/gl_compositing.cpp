// SPDX-License-Identifier: Apache-2.0
#include "executors/gl_compositing.h"

#include <glad/gl.h>
#include <array>
#include <cmath>
#include <span>

#include "base/client.h"
#include "base/enum_words.h"
#include "compositing/codes.h"
#include "executors/fixed_tree.h"
#include "gl/api.h"

namespace lamina {
namespace {

constexpr int child_unit = 6, swizzle_unit = 7;
constexpr int swizzle_width = 256;  // entries in a row, as shaders/slicing/swizzle.frag reads them

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
    if (plan.blending == Blending::fetch) defines.set("FRAMEBUFFER_FETCH", 1);
}

CompositingState::CompositingState(const CompositingPlan& plan, bool opacity_only,
                                   const gl::Framebuffer& target)
    : native_(plan.blending == Blending::native) {
    if (plan.blending == Blending::barrier) target.color().bind(target_unit);
    if (!native_) return;
    gl::api().Enable(GL_BLEND);
    if (plan.order == Order::back_to_front) {
        gl::api().BlendFunc(GL_ONE, opacity_only ? GL_ONE_MINUS_SRC_COLOR : GL_ONE_MINUS_SRC_ALPHA);
    } else {
        gl::api().BlendFunc(opacity_only ? GL_ONE_MINUS_DST_COLOR : GL_ONE_MINUS_DST_ALPHA, GL_ONE);
    }
}

CompositingState::~CompositingState() {
    if (native_) gl::api().Disable(GL_BLEND);
}

void decode(Image& image, const CompositingPlan& plan) {
    const double largest = largest_code(plan.code_bits());
    const double stored = plan.code_bits() > 8 ? 65535 : 255;
    for (float& value : image.rgba)
        value = static_cast<float>(std::round(static_cast<double>(value) * stored) / largest);
}

void finish_layer(const CompositingPlan& plan) {
    if (plan.blending == Blending::barrier) gl::api().TextureBarrier();
}

gl::Defines swizzle_defines(const CompositingPlan& plan) {
    gl::Defines defines;
    set_compositing(defines, plan);
    if (!plan.emulation) defines.set("ALPHA_ROUNDING", static_cast<int>(AlphaRounding::nearest));
    return defines;
}

gl::Defines colorize_defines(const CompositingPlan& plan) {
    gl::Defines defines;
    if (plan.emulation) set_compositing(defines, plan);
    return defines;
}

GlFixedTree::GlFixedTree(const CompositingPlan& plan, const TreeShape& shape,
                         const glm::vec3& single_color, int width, int height)
    : plan_(plan),
      shape_(shape),
      swizzle_("gl/full_screen.vert", "slicing/swizzle.frag", swizzle_defines(plan)),
      colorize_("gl/full_screen.vert", "slicing/colorize.frag", colorize_defines(plan)) {
    for (int level = 0; level < shape_.levels(); ++level) {
        buffers_.emplace_back(gl::Texture::make_2d(opacity_format(plan), width, height));
    }
    for (const auto& [sizes, swizzle] : make_swizzles(shape_, plan.code_bits()))
        swizzles_.emplace(sizes, upload_swizzle(swizzle));
    swizzle_.set("child", child_unit);
    swizzle_.set("swizzle", swizzle_unit);
    if (plan_.blending == Blending::barrier) swizzle_.set("target", target_unit);
    if (plan_.emulation) {
        swizzle_.set("image_rows", height);
        swizzle_.set("seed", static_cast<int>(plan_.emulation->seed));
    }
    colorize_.set("root", child_unit);
    colorize_.set("single_color", single_color);
}

void GlFixedTree::draw(TreeLeaves& leaves, gl::Framebuffer& target, Progress* progress) {
    inserted_nodes_ = 0;
    evaluate(0, shape_.root(), leaves, progress);
    target.bind();
    buffers_[0].color().bind(child_unit);
    gl::draw_full_screen(colorize_, no_attributes_);
}

void GlFixedTree::evaluate(int level, const SampleSpan& node, TreeLeaves& leaves,
                           Progress* progress) {
    gl::Framebuffer& buffer = buffers_[static_cast<std::size_t>(level)];
    buffer.clear(glm::vec4(0));
    if (shape_.is_leaf(level, node)) {
        buffer.bind();
        leaves.draw(node, buffer, static_cast<double>(shape_.samples()) / node.count);
        if (progress != nullptr) {
            gl::api().Finish();
            progress->advance();
        }
        check_interrupt();
        return;
    }
    const int children = shape_.factor(level);
    for (int i = 0; i < children; ++i) {
        const bool back_to_front = plan_.order == Order::back_to_front;
        const SampleSpan child = child_span(node, back_to_front ? children - 1 - i : i, children);
        if (child.count == 0) continue;
        evaluate(level + 1, child, leaves, progress);
        put_into_parent(level, child, node);
    }
}

void GlFixedTree::put_into_parent(int level, const SampleSpan& child, const SampleSpan& node) {
    const gl::Framebuffer& buffer = buffers_[static_cast<std::size_t>(level)];
    buffer.bind();
    const CompositingState state(plan_, true, buffer);
    finish_layer(plan_);
    buffers_[static_cast<std::size_t>(level) + 1].color().bind(child_unit);
    swizzles_.at({child.count, node.count}).bind(swizzle_unit);
    if (plan_.emulation) swizzle_.set("stage", shape_.samples() + inserted_nodes_++);
    gl::draw_full_screen(swizzle_, no_attributes_);
}

}  // namespace lamina
