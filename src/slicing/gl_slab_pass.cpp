// SPDX-License-Identifier: Apache-2.0
#include "slicing/gl_slab_pass.h"

#include <glad/gl.h>

#include <cstddef>
#include <span>
#include <utility>

#include "executors/gl_compositing.h"
#include "gl/api.h"
#include "slicing/texture_bricks.h"

namespace lamina {
namespace {

constexpr int ranks_unit = GlSlabSource::first_free_unit;
constexpr int ranks_width = 256;  // of shaders/slicing/slab.vert

gl::Texture upload_ranks(const Dither& dither) {
    std::vector<float> ranks;
    for (const std::uint64_t seed : {std::uint64_t{dither.seed}, std::uint64_t{dither.seed} + 1}) {
        for (const std::uint32_t rank : dither_ranks(dither.period, seed))
            ranks.push_back(static_cast<float>(rank));
    }
    const int rows = (2 * dither.period + ranks_width - 1) / ranks_width;
    ranks.resize(static_cast<std::size_t>(rows) * ranks_width);
    gl::Texture texture = gl::Texture::make_2d(gl::TextureFormat::r32f, ranks_width, rows);
    texture.upload({0, 0, 0, ranks_width, rows, 1}, std::span<const float>(ranks));
    return texture;
}

}  // namespace

gl::Defines slab_defines(const SlicePlan& plan, gl::Defines segments) {
    gl::Defines& defines = segments;
    if (plan.has_tree(NodeArithmetic::fixed)) defines.set("OPACITY_ONLY", 1);
    if (plan.emulation || plan.dither) set_compositing(defines, plan);
    if (!plan.dither) return defines;
    defines.set("DITHER_PERIOD", plan.dither->period);
    defines.set("DITHER_INCREMENT", plan.dither->increment);
    if (plan.dither->color) defines.set("DITHER_COLOR", 1);
    return defines;
}

void upload_vertices(const std::vector<SlabVertex>& triangles, gl::Buffer& buffer,
                     gl::VertexArray& vertex_array) {
    const std::span<const SlabVertex> vertices(triangles);
    if (vertices.size_bytes() > buffer.byte_count()) {
        buffer = gl::Buffer(vertices);
        vertex_array.set_floats(0, buffer, 2, sizeof(SlabVertex), offsetof(SlabVertex, column));
        vertex_array.set_floats(1, buffer, 1, sizeof(SlabVertex), offsetof(SlabVertex, slab));
    } else if (!vertices.empty()) {
        buffer.write(vertices);
    }
}

GlSlabPass::GlSlabPass(const GlSlabSource& source, const SlicePlan& plan, int image_height)
    : source_(source),
      plan_(plan),
      image_height_(image_height),
      defines_(slab_defines(plan, source.defines())),
      program_("slicing/slab.vert", "slicing/slab.frag", defines_) {
    if (plan_.dither) ranks_ = upload_ranks(*plan_.dither);
    set_up_program();
}

void GlSlabPass::take_plan() {
    gl::Defines wanted = slab_defines(plan_, source_.defines());
    if (wanted == defines_) return;
    program_ = gl::Program("slicing/slab.vert", "slicing/slab.frag", wanted);
    defines_ = std::move(wanted);
    set_up_program();
}

void GlSlabPass::set_up_program() {
    source_.bind(program_);
    if (plan_.blending == Blending::barrier) program_.set("target", target_unit);
    if (plan_.emulation) {
        program_.set("image_rows", image_height_);
        program_.set("seed", static_cast<int>(plan_.emulation->seed));
    }
    if (plan_.dither) program_.set("dither_ranks", ranks_unit);
}

void GlSlabPass::set_view(const View& view, const Slabs& slabs) {
    view_ = view;
    slabs_ = slabs;
    triangles_.clear();
    starts_.clear();
    set_visibility_order(plan_.bricks, source_.grid(), view, plan_.order, bricks_);
    std::erase_if(bricks_, [&](std::size_t brick) { return source_.drawn_box(brick).empty(); });
    for (const std::size_t brick : bricks_) {
        append_slab_polygons(view, source_.grid(), source_.drawn_box(brick), slabs, plan_.order,
                             triangles_, &starts_);
    }
    upload_vertices(triangles_, vertices_, vertex_array_);
    source_.set_view(program_, view, slabs);
}

void GlSlabPass::draw(const SampleSpan& span, const gl::Framebuffer& target, double depth_scale) {
    const bool opacity_only = plan_.has_tree(NodeArithmetic::fixed);
    const CompositingState state(plan_, opacity_only, target);
    if (opacity_only && (plan_.emulation || plan_.dither)) {
        program_.set("depth_scale", depth_scale);  // codes are computed in double
    } else if (opacity_only) {
        program_.set("depth_scale", static_cast<float>(depth_scale));
    }
    if (plan_.dither) ranks_.bind(ranks_unit);
    source_.bind(program_);
    program_.use();
    vertex_array_.bind();
    for (std::size_t place = 0; place < bricks_.size(); ++place) {
        source_.set_brick(program_, *view_, slabs_, bricks_[place]);
        draw_brick(place, span);
    }
}

void GlSlabPass::draw_brick(std::size_t place, const SampleSpan& span) {
    const std::size_t* const starts =
        starts_.data() + place * static_cast<std::size_t>(slabs_.count + 1);
    const bool front_to_back = plan_.order == Order::front_to_back;
    const int first = front_to_back ? span.first : slabs_.count - span.end();
    const auto draw_slabs = [&](int from, int count) {
        const std::size_t begin = starts[from], end = starts[from + count];
        if (end > begin) {
            gl::api().DrawArrays(GL_TRIANGLES, static_cast<int>(begin),
                                 static_cast<int>(end - begin));
        }
    };
    if (plan_.blending != Blending::barrier) {
        draw_slabs(first, span.count);
        return;
    }
    for (int i = 0; i < span.count; ++i) {
        draw_slabs(first + i, 1);
        finish_layer(plan_);
    }
}

}  // namespace lamina
