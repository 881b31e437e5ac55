// SPDX-License-Identifier: Apache-2.0
#include "projection/gl_project_renderer.h"

#include <glad/gl.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <utility>

#include "base/enum_words.h"
#include "base/parallel.h"
#include "base/profile.h"
#include "executors/gl_compositing.h"
#include "executors/gl_optics.h"
#include "facts/world_unit.h"
#include "gl/api.h"
#include "projection/fan_geometry.h"
#include "projection/tet_geometry.h"
#include "scene/camera.h"

namespace lamina {
namespace {

// Distance, in steps of the rasteriser's grid, by which corners of silhouettes lie outside
// (screen_polygon.h).
constexpr double margin_steps = 2;

constexpr std::array silhouette_attributes{
    GlTetStream::Attribute{2, offsetof(SilhouetteVertex, position), false},
    GlTetStream::Attribute{1, offsetof(SilhouetteVertex, record), true}};
constexpr std::array fan_attributes{GlTetStream::Attribute{2, offsetof(FanVertex, position), false},
                                    GlTetStream::Attribute{3, offsetof(FanVertex, inverse), false},
                                    GlTetStream::Attribute{4, offsetof(FanVertex, front), false},
                                    GlTetStream::Attribute{4, offsetof(FanVertex, back), false},
                                    GlTetStream::Attribute{2, offsetof(FanVertex, scalars), false},
                                    GlTetStream::Attribute{1, offsetof(FanVertex, tet), true}};

bool is_fan(const ProjectPlan& plan) {
    return plan.geometry == ProjectGeometry::triangles;
}

}  // namespace

bool has_program(const ProjectPlan& plan, FragmentKind kind) {
    switch (kind) {
        case FragmentKind::thin:
            return plan.plain && plan.source == SegmentSource::parts && !plan.single_color;
        case FragmentKind::plain:
            return plan.plain;
        case FragmentKind::careful:
            return !is_fan(plan);
    }
    unreachable_enum();
}

gl::Defines project_defines(const ProjectPlan& plan, FragmentKind kind) {
    gl::Defines defines;
    if (is_fan(plan)) defines.set("FAN", 1);
    if (kind == FragmentKind::thin) defines.set("THIN", 1);
    if (kind == FragmentKind::careful) defines.set("CAREFUL", 1);
    if (!plan.tree.empty()) defines.set("OPACITY_ONLY", 1);
    if (plan.source != SegmentSource::constant) defines.set("SCALARS", 1);
    if (plan.windowed) defines.set("WINDOWED", 1);
    if (kind == FragmentKind::careful && plan.source != SegmentSource::parts)
        defines.set("EXACT_RUNS", 1);
    if (plan.orthographic) defines.set("ORTHOGRAPHIC", 1);
    if (plan.lighting) {
        defines.set("LIT", 1);
        set_light_defines(*plan.lighting, defines);
    }
    if (plan.thickness == Thickness::dz) defines.set("THICKNESS_DZ", 1);
    if (plan.interpolation == Interpolation::linear) defines.set("LINEAR", 1);
    if (!plan.in_codes()) return defines;
    if (plan.dither == ProjectDither::after_blend) {
        defines.set("BITS", plan.code_bits());
        defines.set("AFTER_BLEND", 1);
        if (plan.blending == Blending::fetch) defines.set("FRAMEBUFFER_FETCH", 1);
        return defines;
    }
    set_compositing(defines, plan);
    if (plan.dither == ProjectDither::alpha) defines.set("DITHER_ALPHA", 1);
    return defines;
}

GlProjectRenderer::GlProjectRenderer(const SceneMesh& mesh,
                                     const TransferFunction& transfer_function,
                                     const ProjectPlan& plan, const Capabilities& capabilities,
                                     int width, int height, std::shared_ptr<VisibilityOrder> order,
                                     std::shared_ptr<GlTetStream> stream)
    : mesh_(mesh),
      transfer_function_(in_units(transfer_function, plan.unit)),
      plan_(plan),
      margin_(margin_steps / std::exp2(capabilities.subpixel_bits)),
      target_(gl::Texture::make_2d(color_format(plan), width, height)),
      pieces_(transfer_function_, plan.range),
      order_(order_for(mesh, plan, std::move(order))) {
    if (plan_.nothing_visible) return;
    tables_.emplace(transfer_function_, plan_);
    if (plan_.lighting)
        gradients_ = StoredGradients(gradients_of(mesh), *plan_.lighting->smallest_gradient);
    for (std::size_t i = 0; i < fragment_kinds; ++i) {
        const auto kind = static_cast<FragmentKind>(i);
        if (has_program(plan_, kind)) programs_[i].emplace(make_program(kind));
    }
    Stage cutting("visible parts");
    parts_.emplace(mesh.mesh, mesh.scalar.values, pieces_, plan_.source == SegmentSource::parts,
                   plan_.draw_transparent);
    cutting.end();
    if (parts_->count() == 0) return;
    make_stream(std::move(stream));
    if (!plan_.tree.empty()) make_tree();
}

void GlProjectRenderer::make_stream(std::shared_ptr<GlTetStream> ready) {
    const auto parts = static_cast<std::size_t>(parts_->count());
    const bool fan = is_fan(plan_);
    const TetGeometry::Size size =
        fan ? FanGeometry::largest_size()
            : SilhouetteGeometry::largest_size(plan_.lighting.has_value());
    stream_ = std::move(ready);
    if (!stream_ || !stream_->serves(size, parts)) {
        stream_ = fan ? std::make_shared<GlTetStream>(size, fan_attributes, parts)
                      : std::make_shared<GlTetStream>(size, silhouette_attributes, parts);
    }
    stream_->set_barriers(plan_.blending == Blending::barrier);
}

// The samples of a ray are the cell fragments, as many in every view.
void GlProjectRenderer::make_tree() {
    CompositingPlan nodes = plan_;
    if (!plan_.emulation) nodes.blending = Blending::native;  // only leaves are dithered
    const TreeShape shape(plan_.tree, static_cast<int>(parts_->count()));
    tree_.emplace(nodes, shape, tables_->single_color(), target_.width(), target_.height());
}

gl::Program GlProjectRenderer::make_program(FragmentKind kind) const {
    gl::Defines defines = project_defines(plan_, kind);
    tables_->set_defines(defines);
    return {is_fan(plan_) ? "projection/fan.vert" : "projection/silhouette.vert",
            "projection/tet.frag", defines};
}

int GlProjectRenderer::step_count() const {
    if (tree_) return tree_->step_count();
    return stream_
               ? static_cast<int>(stream_->batch_count(static_cast<std::size_t>(parts_->count())))
               : 0;
}

bool GlProjectRenderer::take(const Plan& plan) {
    return plan.project.picture() == plan_.picture();
}

void GlProjectRenderer::draw(const View& view, Progress* progress) {
    target_.bind();
    target_.clear(glm::vec4(0));
    order_ms_ = draw_ms_ = 0;
    tets_drawn_ = 0;
    if (!stream_) return;
    Stage ordering("order");
    const DrawOrder<TetPart> parts =
        parts_->sorted(*order_, view, plan_.scattered, plan_.solve_rings);
    order_ms_ = ordering.end();
    Stage drawing("draw");
    for (auto& program : programs_) {
        if (program) set_view(*program, view);
    }
    draw_parts(parts, seeing_in_units(view, plan_.unit), progress);
    Stage finishing("finish");
    gl::api().Finish();
    finishing.end();
    drawing.count("tets", static_cast<double>(tets_drawn_));
    draw_ms_ = drawing.end();
    stream_->end_frame();
}

void GlProjectRenderer::set_view(gl::Program& program, const View& view) const {
    tables_->bind(program);
    const glm::vec2 size(view.width, view.height);
    program.set("image_size", size);
    program.set("image_middle", 0.5f * size);
    program.set("pixel_size", static_cast<float>(seeing_in_units(view, plan_.unit).pixel));
    if (!is_fan(plan_)) {
        program.set("ray_perturbation", ray_perturbation(view));
        const double near =
            view.projection == Projection::perspective ? -1 / plan_.near_depth : plan_.near_depth;
        program.set("near_depth", static_cast<float>(near));
    }
    if (plan_.in_codes()) {
        program.set("image_rows", view.height);
        program.set("seed", static_cast<int>(plan_.seed));
    }
    if (plan_.blending == Blending::barrier) program.set("target", target_unit);
    if (plan_.lighting) set_light(program, view);
}

void GlProjectRenderer::set_light(gl::Program& program, const View& view) const {
    set_lights(*plan_.lighting, world_axes, program);
    const auto axis = [](const glm::dvec3& v) { return glm::vec4(glm::vec3(v), 0); };
    const std::array axes{axis(view.right), axis(view.up), axis(view.forward)};
    program.set("view_axes", std::span<const glm::vec4>(axes));
    set_light_cuts(*plan_.lighting, program);
    program.set("light_limits",
                glm::vec2(gradients_.smallest_square(*plan_.lighting), plan_.most_bend));
}

void GlProjectRenderer::draw_parts(const DrawOrder<TetPart>& parts, const View& view,
                                   Progress* progress) {
    std::optional<FanGeometry> fans;
    std::optional<SilhouetteGeometry> silhouettes;
    if (is_fan(plan_)) {
        fans.emplace(mesh_, transfer_function_, plan_, view);
    } else {
        silhouettes.emplace(TetProjector(mesh_.mesh, mesh_.scalar.values, plan_.range, pieces_,
                                         view, plan_.near_depth, margin_, gradients_.at_points));
    }
    const TetGeometry& geometry = fans ? static_cast<const TetGeometry&>(*fans) : *silhouettes;
    // A kind without a program is drawn by the next kind that has one. Fans are all plain.
    GlTetStream::Programs programs{};
    gl::Program* last = nullptr;
    for (std::size_t i = fragment_kinds; i-- > 0;) {
        if (programs_[i]) last = &*programs_[i];
        programs[i] = last;
    }
    stream_->start_frame();
    if (tree_) {
        GlTetLeaves leaves(plan_, *stream_, geometry, parts, parts_->count(), programs);
        tree_->draw(leaves, target_, progress);
        tets_drawn_ = leaves.drawn();
        return;
    }
    const CompositingState state(plan_, false, target_);
    tets_drawn_ = stream_->draw(geometry, parts, target_.height(), programs, [&] {
        if (progress != nullptr) progress->advance();
    });
}

void GlProjectRenderer::read(Image& image) const {
    target_.read_back(image);
    if (plan_.in_codes() && plan_.blending != Blending::native) decode(image, plan_);
}

std::map<std::string, double> GlProjectRenderer::stages_ms() const {
    return {{"tables", table_ms()},
            {"order", order_ms()},
            {"geometry", geometry_ms()},
            {"draw", draw_ms()}};
}

}  // namespace lamina
