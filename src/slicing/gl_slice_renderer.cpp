// SPDX-License-Identifier: Apache-2.0
#include "slicing/gl_slice_renderer.h"

#include <glad/gl.h>

#include <utility>

#include "base/client.h"
#include "base/profile.h"
#include "executors/gl_compositing.h"
#include "facts/world_unit.h"
#include "gl/api.h"

namespace lamina {

GlSliceRenderer::GlSliceRenderer(const Volume& volume, const TransferFunction& transfer_function,
                                 const Facts& facts, const SlicePlan& plan,
                                 const Capabilities& capabilities, int width, int height,
                                 std::shared_ptr<const VolumeTextures> ready)
    : plan_(plan),
      grid_(in_units(facts.grid, plan.unit)),
      target_(gl::Texture::make_2d(color_format(plan), width, height)) {
    if (plan_.nothing_visible) {
        kept_ = std::move(ready);
        return;
    }
    source_.emplace(volume, in_units(transfer_function, plan_.unit), facts, plan_,
                    std::move(ready));
    if (plan_.has_tree(NodeArithmetic::shader)) {
        shader_tree_.emplace(*source_, plan_, capabilities, width, height);
        return;
    }
    slabs_.emplace(*source_, plan_, height);
    if (plan_.has_tree(NodeArithmetic::fixed)) {
        fixed_tree_.emplace(plan_, TreeShape(plan_.tree->factors, plan_.slabs),
                            source_->single_color(), width, height);
    }
}

// Nothing was made if nothing was visible.
bool GlSliceRenderer::take(const Plan& plan) {
    const SlicePlan& slice = plan.slice;
    if ((!source_ && !slice.nothing_visible) || of_all_views(slice) != of_all_views(plan_))
        return false;
    plan_ = slice;
    if (plan_.nothing_visible) return true;
    source_->take_plan(plan_);
    if (slabs_) slabs_->take_plan();
    if (shader_tree_) shader_tree_->take_plan();
    return true;
}

int GlSliceRenderer::step_count() const {
    if (shader_tree_) return shader_tree_->step_count();
    if (fixed_tree_) return fixed_tree_->step_count();
    return slabs_ ? plan_.batches : 0;
}

void GlSliceRenderer::draw(const View& world_view, Progress* progress) {
    const View view = in_units(world_view, plan_.unit);
    target_.bind();
    target_.clear(glm::vec4(0));
    geometry_ms_ = draw_ms_ = 0;
    if (!source_ || plan_.nothing_visible) return;
    Stage geometry("geometry");
    const DepthRange depth = depth_range(grid_, view);
    if (depth.far <= depth.near) return;
    const Slabs slabs{depth.near, depth.far, plan_.slabs};
    if (shader_tree_) shader_tree_->set_view(view, slabs);
    if (slabs_) slabs_->set_view(view, slabs);
    geometry_ms_ = geometry.end();
    Stage drawing("draw");
    timeline_.begin("draw");
    if (shader_tree_) shader_tree_->draw(target_, progress);
    if (fixed_tree_) {
        fixed_tree_->draw(*slabs_, target_, progress);
    } else if (slabs_) {
        draw_straight(progress);
    }
    timeline_.end();
    gl::api().Finish();
    draw_ms_ = drawing.end();
    timeline_.collect();
    gl::check("drawing the slabs");
}

// Draws plan_.batches times an equal number of slabs, and waits for each.
void GlSliceRenderer::draw_straight(Progress* progress) {
    const SampleSpan all{0, plan_.slabs};
    for (int batch = 0; batch < plan_.batches; ++batch) {
        const bool front_to_back = plan_.order == Order::front_to_back;
        const SampleSpan part =
            child_span(all, front_to_back ? batch : plan_.batches - 1 - batch, plan_.batches);
        if (part.count > 0) slabs_->draw(part, target_, 1);
        gl::api().Finish();
        check_interrupt();
        if (progress != nullptr) progress->advance();
    }
}

void GlSliceRenderer::read(Image& image) const {
    target_.read_back(image);
    if (plan_.emulation) decode(image, plan_);
}

std::map<std::string, double> GlSliceRenderer::stages_ms() const {
    return {{"tables", table_ms()},
            {"upload", upload_ms()},
            {"geometry", geometry_ms()},
            {"draw", draw_ms()}};
}

}  // namespace lamina
