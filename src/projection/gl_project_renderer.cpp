// SPDX-License-Identifier: Apache-2.0
#include "projection/gl_project_renderer.h"

#include <glad/gl.h>

#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <memory>

#include "base/parallel.h"
#include "base/stopwatch.h"
#include "gl/check.h"
#include "projection/fan_geometry.h"
#include "projection/silhouette_geometry.h"
#include "slicing/gl_compositing.h"

namespace lamina {
namespace {

// Corners of silhouettes lie this many steps of the rasteriser's grid outside (screen_polygon.h).
constexpr double margin_steps = 2;

// Rays that run along faces are moved by so many pixels: far below what pictures resolve, far above
// the rounding of doubles.
constexpr double tie_pixels = 1e-7;

constexpr std::array silhouette_attributes{
    GlTetStream::Attribute{2, offsetof(SilhouetteVertex, position), false},
    GlTetStream::Attribute{1, offsetof(SilhouetteVertex, record), true}};
constexpr std::array fan_attributes{GlTetStream::Attribute{2, offsetof(FanVertex, position), false},
                                    GlTetStream::Attribute{2, offsetof(FanVertex, inverse), false},
                                    GlTetStream::Attribute{4, offsetof(FanVertex, front), false},
                                    GlTetStream::Attribute{4, offsetof(FanVertex, back), false},
                                    GlTetStream::Attribute{1, offsetof(FanVertex, tet), true}};

bool is_fan(const ProjectPlan& plan) {
    return plan.geometry == ProjectGeometry::triangles;
}

std::vector<char> find_hidden(const SceneMesh& mesh, const TransferFunction& transfer_function) {
    const auto tets = mesh.mesh.tets();
    std::vector<char> hidden(tets.size());
    parallel_for(static_cast<std::int64_t>(tets.size()), 4096, [&](std::int64_t index) {
        const auto tet = static_cast<std::size_t>(index);
        hidden[tet] = shows_nothing(transfer_function, mesh.scalar.values, tets[tet]);
    });
    return hidden;
}

// The direction into which the tracer moves rays that meet edges and corners (mesh/ray_walk.cpp):
// along the world's x, y and z, the later ones much less. Its parts along right, up and forward.
glm::dvec3 tie_shift(const View& view) {
    const glm::dvec3 direction(1, 3e-3, 1e-5);
    const bool perspective = view.projection == Projection::perspective;
    return tie_pixels * glm::dvec3(glm::dot(view.right, direction), glm::dot(view.up, direction),
                                   perspective ? glm::dot(view.forward, direction) : 0);
}

}  // namespace

gl::Defines project_defines(const ProjectPlan& plan, TetPrecision precision) {
    gl::Defines defines;
    if (is_fan(plan)) defines.set("FAN", 1);
    if (precision == TetPrecision::careful) defines.set("CAREFUL", 1);
    if (plan.source != SegmentSource::constant) defines.set("SCALARS", 1);
    if (plan.orthographic) defines.set("ORTHOGRAPHIC", 1);
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
                                     int width, int height)
    : mesh_(mesh),
      transfer_function_(transfer_function),
      plan_(plan),
      margin_(margin_steps / std::exp2(capabilities.subpixel_bits)),
      target_(gl::Texture::make_2d(color_format(plan), width, height)),
      order_(mesh.mesh, plan.nothing_visible ? OrderMethod::none : plan.visibility) {
    if (plan_.nothing_visible) return;
    tables_.emplace(transfer_function, plan_);
    if (plan_.plain) program_.emplace(make_program(TetPrecision::plain));
    if (!is_fan(plan_)) careful_program_.emplace(make_program(TetPrecision::careful));
    const std::size_t tets = mesh.mesh.tets().size();
    if (is_fan(plan_)) {
        stream_.emplace(FanGeometry::largest_size(), fan_attributes, tets);
    } else {
        stream_.emplace(SilhouetteGeometry::largest_size(), silhouette_attributes, tets);
    }
    stream_->set_barriers(plan_.blending == Blending::barrier);
    if (!plan_.draw_transparent) hidden_ = find_hidden(mesh, transfer_function);
}

gl::Program GlProjectRenderer::make_program(TetPrecision precision) const {
    gl::Defines defines = project_defines(plan_, precision);
    tables_->set_defines(defines);
    return {is_fan(plan_) ? "projection/fan.vert" : "projection/silhouette.vert",
            "projection/tet.frag", defines};
}

int GlProjectRenderer::step_count() const {
    return stream_ ? static_cast<int>(stream_->batch_count(mesh_.mesh.tets().size())) : 0;
}

void GlProjectRenderer::draw(const View& view, Progress* progress) {
    target_.bind();
    target_.clear(glm::vec4(0));
    order_ms_ = draw_ms_ = 0;
    tets_drawn_ = 0;
    if (!stream_) return;
    const Stopwatch order_watch;
    const auto tets = visible_tets(view);
    order_ms_ = order_watch.milliseconds();
    const Stopwatch draw_watch;
    if (program_) set_view(*program_, view);
    if (careful_program_) set_view(*careful_program_, view);
    draw_tets(tets, view, progress);
    glFinish();
    draw_ms_ = draw_watch.milliseconds();
}

std::span<const std::int32_t> GlProjectRenderer::visible_tets(const View& view) {
    const auto order = order_.sort(eye_of(view));
    if (hidden_.empty()) return order;
    visible_.clear();
    visible_.reserve(order.size());
    for (const std::int32_t tet : order) {
        if (!hidden_[static_cast<std::size_t>(tet)]) visible_.push_back(tet);
    }
    return visible_;
}

void GlProjectRenderer::set_view(gl::Program& program, const View& view) const {
    tables_->bind(program);
    const glm::vec2 size(view.width, view.height);
    program.set("image_size", size);
    program.set("image_middle", 0.5f * size);
    program.set("pixel_size", static_cast<float>(view.pixel));
    if (!is_fan(plan_)) {
        program.set("tie_shift", tie_shift(view));
        const double near =
            view.projection == Projection::perspective ? -1 / plan_.near_depth : plan_.near_depth;
        program.set("near_depth", static_cast<float>(near));
    }
    if (plan_.in_codes()) {
        program.set("image_rows", view.height);
        program.set("seed", static_cast<int>(plan_.seed));
    }
    if (plan_.blending == Blending::barrier) program.set("target", target_unit);
}

void GlProjectRenderer::draw_tets(std::span<const std::int32_t> tets, const View& view,
                                  Progress* progress) {
    std::unique_ptr<TetGeometry> geometry;
    if (is_fan(plan_)) {
        geometry = std::make_unique<FanGeometry>(mesh_, transfer_function_, plan_, view);
    } else {
        geometry = std::make_unique<SilhouetteGeometry>(TetProjector(
            mesh_.mesh, mesh_.scalar.values, plan_.range, view, plan_.near_depth, margin_));
    }
    const CompositingState state(plan_, false, target_);
    const gl::Program& careful = careful_program_ ? *careful_program_ : *program_;
    const gl::Program& plain = program_ ? *program_ : careful;
    tets_drawn_ = stream_->draw(*geometry, tets, {plain, careful}, [&] {
        if (progress != nullptr) progress->advance();
    });
}

Image GlProjectRenderer::read() const {
    Image image = target_.read_back();
    if (plan_.in_codes() && plan_.blending != Blending::native) decode(image, plan_);
    return image;
}

}  // namespace lamina
