// SPDX-License-Identifier: Apache-2.0
// Draws a frame of a volume with OpenGL, as slice_renderer.cpp does on the CPU:
//   1. Cut the boxes of the bricks, in visibility order, into slabs; each covers a convex polygon.
//   2. Draw the polygons. For each pixel slab.frag computes the colour and opacity of its segment.
//   3. Blend the fragments onto the target in the plan's order.
// With a tree of fixed-point nodes, GlFixedTree composites the pictures of the leaves. Trees in
// float, the default, and Target::emulated, with a tree or without, are drawn by compute shaders
// instead (gl_shader_tree.h, gl_code_slabs.h).
#include "slicing/gl_slice_renderer.h"

#include <glad/gl.h>
#include <cstddef>
#include <span>
#include <utility>

#include "base/client.h"
#include "base/profile.h"
#include "gl/api.h"
#include "scene/camera.h"
#include "slicing/gl_code_slabs.h"
#include "slicing/gl_shader_tree.h"
#include "slicing/slab_geometry.h"

namespace lamina {
namespace {

// Uploads vertices for attributes 0 (position) and 1 (slab). The buffer grows if they do not fit.
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
    if (!plan_.dither) return;
    program_.set("image_rows", image_height_);
    program_.set("dither_ranks", ranks_unit);
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
    program_.set("image_size",
                 glm::vec2(static_cast<float>(view.width), static_cast<float>(view.height)));
}

void GlSlabPass::draw(const SampleSpan& span, double depth_scale) {
    const bool opacity_only = plan_.has_tree(NodeArithmetic::fixed);
    const CompositingState state(plan_, opacity_only);
    if (opacity_only && plan_.dither) {
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
    const std::size_t begin = starts[first], end = starts[first + span.count];
    if (end > begin)
        gl::api().DrawArrays(GL_TRIANGLES, static_cast<int>(begin), static_cast<int>(end - begin));
}

GlSliceRenderer::GlSliceRenderer(const Volume& volume, const TransferFunction& transfer_function,
                                 const Facts& facts, const SlicePlan& plan,
                                 const Capabilities& capabilities, int width, int height,
                                 std::shared_ptr<const GlVolume> ready)
    : plan_(plan), grid_(in_units(facts.grid, plan.unit)) {
    const auto make_target = [&] {
        target_.emplace(gl::Texture::make_2d(color_format(plan), width, height));
    };
    if (plan_.nothing_visible) {
        make_target();
        kept_ = std::move(ready);
        return;
    }
    source_.emplace(volume, in_units(transfer_function, plan_.unit), facts, plan_,
                    std::move(ready));
    if (plan_.has_tree(NodeArithmetic::shader)) {
        marched_ = std::make_unique<GlShaderTree>(*source_, plan_, capabilities, width, height);
        return;
    }
    if (plan_.blending == Blending::registers) {
        marched_ = std::make_unique<GlCodeSlabs>(*source_, plan_, capabilities, width, height);
        return;
    }
    make_target();
    slabs_.emplace(*source_, plan_, height);
    if (plan_.has_tree(NodeArithmetic::fixed)) {
        fixed_tree_.emplace(plan_, TreeShape(plan_.tree->factors, plan_.slabs),
                            source_->single_color(), width, height);
    }
}

// A renderer of a plan with nothing visible has no source, and can only take such plans.
bool GlSliceRenderer::try_switch_to(const Plan& plan) {
    const SlicePlan& slice = plan.slice;
    if ((!source_ && !slice.nothing_visible) || of_all_views(slice) != of_all_views(plan_))
        return false;
    plan_ = slice;
    if (plan_.nothing_visible) return true;
    source_->take_plan(plan_);
    if (slabs_) slabs_->take_plan();
    if (marched_) marched_->take_plan();
    return true;
}

int GlSliceRenderer::step_count() const {
    if (marched_) return marched_->step_count();
    if (fixed_tree_) return fixed_tree_->step_count();
    return slabs_ ? plan_.batches : 0;
}

void GlSliceRenderer::draw(const View& world_view, Progress* progress) {
    const View view = in_units(world_view, plan_.unit);
    if (marched_) marched_->clear();
    if (target_) {
        target_->bind();
        target_->clear(glm::vec4(0));
    }
    geometry_ms_ = draw_ms_ = 0;
    if (!source_ || plan_.nothing_visible) return;
    Stage geometry("geometry");
    const DepthRange depth = depth_range(grid_, view);
    if (depth.far <= depth.near) return;
    const Slabs slabs{depth.near, depth.far, plan_.slabs};
    if (marched_) marched_->set_view(view, slabs);
    if (slabs_) slabs_->set_view(view, slabs);
    geometry_ms_ = geometry.end();
    Stage drawing("draw");
    timeline_.begin("draw");
    if (marched_) marched_->draw(progress);
    if (fixed_tree_) {
        fixed_tree_->draw(*slabs_, *target_, progress);
    } else if (slabs_) {
        draw_straight(progress);
    }
    timeline_.end();
    if (marched_) {
        marched_->end_frame();
    } else {
        gl::api().Finish();
    }
    draw_ms_ = drawing.end();
    timeline_.collect();
    gl::check("drawing the slabs");
}

// Draws the slabs in plan_.batches equal batches, and waits for each.
void GlSliceRenderer::draw_straight(Progress* progress) {
    const SampleSpan all{0, plan_.slabs};
    for (int batch = 0; batch < plan_.batches; ++batch) {
        const bool front_to_back = plan_.order == Order::front_to_back;
        const SampleSpan part =
            child_span(all, front_to_back ? batch : plan_.batches - 1 - batch, plan_.batches);
        if (part.count > 0) slabs_->draw(part, 1);
        gl::api().Finish();
        check_interrupt();
        if (progress != nullptr) progress->advance();
    }
}

void GlSliceRenderer::read(Image& image) const {
    if (marched_) {
        marched_->read(image);
    } else {
        target_->read_back(image);
    }
}

std::map<std::string, double> GlSliceRenderer::stages_ms() const {
    return {{"tables", source_ ? source_->table_ms() : 0},
            {"upload", source_ ? source_->upload_ms() : 0},
            {"geometry", geometry_ms_},
            {"draw", draw_ms_}};
}

}  // namespace lamina
