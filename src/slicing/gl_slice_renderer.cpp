// SPDX-License-Identifier: Apache-2.0
#include "slicing/gl_slice_renderer.h"

#include <glad/gl.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>

#include "base/interrupt.h"
#include "base/stopwatch.h"
#include "gl/check.h"
#include "gl/query.h"
#include "slicing/shader_intervals.h"
#include "slicing/texture_bricks.h"

namespace lamina {
namespace {

gl::TextureFormat format_of(Target target) {
    switch (target) {
        case Target::float32:
            return gl::TextureFormat::rgba32f;
        case Target::float16:
            return gl::TextureFormat::rgba16f;
        case Target::fixed16:
            return gl::TextureFormat::rgba16;
        default:
            return gl::TextureFormat::rgba8;
    }
}

int sampling_define(VolumeSampling sampling) {
    switch (sampling) {
        case VolumeSampling::none:
            return 0;
        case VolumeSampling::fetch:
            return 1;
        default:
            return 2;
    }
}

// Shaders see scalars with this range as [0, 1]; that of a constant volume is widened, so that it
// has a width.
ValueRange shader_range(const ValueRange& range) {
    return range.hi > range.lo ? range
                               : ValueRange{range.lo, range.lo + std::max(1.0, std::abs(range.lo))};
}

}  // namespace

gl::Defines slab_defines(const SlicePlan& plan, int intervals, int table_nodes) {
    gl::Defines defines;
    defines.set("SAMPLING", sampling_define(plan.sampling));
    if (plan.orthographic) defines.set("ORTHOGRAPHIC", 1);
    if (plan.precise_rays) defines.set("PRECISE_RAYS", 1);
    if (plan.single_color) defines.set("SINGLE_COLOR", 1);
    if (plan.sampling == VolumeSampling::none) return defines;
    if (plan.nan_transparent) defines.set("NAN_TRANSPARENT", 1);
    defines.set("INTERVALS", intervals);
    if (!plan.uses_table()) return defines;
    defines.set("PREINTEGRATED", 1);
    defines.set("TABLE_NODES", table_nodes);
    if (plan.table_filtered) defines.set("TABLE_FILTERED", 1);
    if (!plan.table.colored) return defines;
    defines.set("TABLE_COLORED", 1);
    defines.set("TABLE_LAYERS", plan.table.length_layers);
    return defines;
}

GlSliceRenderer::GlSliceRenderer(const Volume& volume, const TransferFunction& transfer_function,
                                 const Facts& facts, const SlicePlan& plan, int width, int height)
    : facts_(facts),
      plan_(plan),
      range_(shader_range(facts.range)),
      target_(gl::Texture::make_2d(format_of(plan.target), width, height)) {
    if (plan_.nothing_visible) return;
    const Stopwatch table_watch;
    make_program(transfer_function);
    table_ms_ = table_watch.milliseconds();
    const Stopwatch upload_watch;
    volume_ = upload_volume(volume, range_, plan);
    glFinish();
    upload_ms_ = upload_watch.milliseconds();
    gl::check("uploading the volume");
}

void GlSliceRenderer::make_program(const TransferFunction& transfer_function) {
    const bool has_scalars = plan_.sampling != VolumeSampling::none;
    if (has_scalars) tables_.emplace(transfer_function, range_, plan_);
    program_.emplace("slicing/slab.vert", "slicing/slab.frag",
                     has_scalars ? slab_defines(plan_, tables_->intervals(), tables_->nodes())
                                 : slab_defines(plan_, 0, 0));
    program_->set("single_color", glm::vec3(first_color(transfer_function, range_)));
    if (has_scalars) {
        tables_->bind(*program_);
        program_->set("volume", GlTransferTables::first_free_unit);
    } else {
        const OpticalProperties optics = transfer_function.at(range_.lo);
        const double extinction = std::min(optics.extinction, max_shader_extinction);
        program_->set("constant_optics",
                      glm::vec4(glm::vec3(optics.color), static_cast<float>(extinction)));
    }
}

void GlSliceRenderer::make_geometry(const View& view) {
    const DepthRange depth = depth_range(facts_.grid, view);
    slabs_ = {depth.near, depth.far, plan_.slabs};
    triangles_.clear();
    draws_.clear();
    if (depth.far <= depth.near) return;
    for (const std::size_t brick : visibility_order(plan_.bricks, facts_.grid, view, plan_.order)) {
        IndexBox box = box_of(plan_.bricks[brick], facts_.grid);
        box.min = glm::max(box.min, plan_.drawn.min);
        box.max = glm::min(box.max, plan_.drawn.max);
        if (box.empty()) continue;
        const std::size_t first = triangles_.size();
        append_slab_polygons(view, facts_.grid, box, slabs_, plan_.order, triangles_);
        if (triangles_.size() > first) draws_.push_back({brick, first, triangles_.size()});
    }
    const std::span<const SlabVertex> vertices(triangles_);
    if (vertices.size_bytes() > vertices_.byte_count()) {
        vertices_ = gl::Buffer(vertices);
        vertex_array_.set_floats(0, vertices_, 2, sizeof(SlabVertex), offsetof(SlabVertex, column));
        vertex_array_.set_floats(1, vertices_, 2, sizeof(SlabVertex), offsetof(SlabVertex, front));
    } else if (!vertices.empty()) {
        vertices_.write(vertices);
    }
}

void GlSliceRenderer::set_ray(const char* name, const glm::dvec3& coefficient) {
    if (plan_.precise_rays) {
        program_->set(name, coefficient);
    } else {
        program_->set(name, glm::vec3(coefficient));
    }
}

void GlSliceRenderer::set_view(const View& view) {
    gl::Program& program = *program_;
    program.set("image_size",
                glm::vec2(static_cast<float>(view.width), static_cast<float>(view.height)));
    program.set("image_middle", glm::vec2(0.5f * static_cast<float>(view.width),
                                          0.5f * static_cast<float>(view.height)));
    program.set("pixel_size", static_cast<float>(view.pixel));
    program.set("normalisation", volume_.normalisation);
    // Depth in the shader is relative to the nearest slab's front.
    const bool perspective = view.projection == Projection::perspective;
    const glm::dvec3 column = facts_.grid.direction_to_index(view.pixel * view.right);
    const glm::dvec3 row = facts_.grid.direction_to_index(-view.pixel * view.up);
    const double spread = perspective ? slabs_.near : 1;
    set_ray("origin_column", spread * column);
    set_ray("origin_row", spread * row);
    set_ray("direction_middle", facts_.grid.direction_to_index(view.forward));
    set_ray("direction_column", perspective ? column : glm::dvec3(0));
    set_ray("direction_row", perspective ? row : glm::dvec3(0));
    if (!perspective) program.set("pixel_size", 0.0f);
}

void GlSliceRenderer::set_brick(const View& view, std::size_t brick) {
    gl::Program& program = *program_;
    const TextureBrick& texture = plan_.bricks[brick];
    const glm::dvec3 first{texture.first[0], texture.first[1], texture.first[2]};
    const IndexBox box = box_of(texture, facts_.grid);
    set_ray("origin_middle", facts_.grid.to_index(view.eye + slabs_.near * view.forward) - first);
    program.set("box_min", glm::vec3(box.min - first));
    program.set("box_max", glm::vec3(box.max - first));
    program.set("last_sample",
                glm::vec3(glm::dvec3(texture.size[0], texture.size[1], texture.size[2]) - 1.0));
    if (!volume_.bricks.empty()) volume_.bricks[brick].bind(GlTransferTables::first_free_unit);
}

void GlSliceRenderer::draw(const View& view, Progress* progress) {
    target_.bind();
    target_.clear(glm::vec4(0));
    geometry_ms_ = draw_ms_ = 0;
    if (plan_.nothing_visible) return;
    const Stopwatch geometry_watch;
    make_geometry(view);
    set_view(view);
    geometry_ms_ = geometry_watch.milliseconds();
    const Stopwatch draw_watch;
    glEnable(GL_BLEND);
    if (plan_.order == Order::back_to_front) {
        glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    } else {
        glBlendFunc(GL_ONE_MINUS_DST_ALPHA, GL_ONE);
    }
    program_->use();
    vertex_array_.bind();
    draw_batches(view, progress);
    glDisable(GL_BLEND);
    draw_ms_ = draw_watch.milliseconds();
    gl::check("drawing the slabs");
}

// All triangles in order, in plan_.batches parts of equal size; a part may end in one brick and go
// on in the next.
void GlSliceRenderer::draw_batches(const View& view, Progress* progress) {
    const std::size_t count = triangles_.size() / 3;
    std::size_t drawn = 0, brick = 0;
    for (int batch = 1; batch <= plan_.batches; ++batch) {
        const std::size_t end =
            3 * (count * static_cast<std::size_t>(batch) / static_cast<std::size_t>(plan_.batches));
        while (drawn < end) {
            const BrickDraw& draw = draws_[brick];
            if (drawn == draw.first_vertex) set_brick(view, draw.brick);
            const std::size_t part = std::min(end, draw.end_vertex) - drawn;
            glDrawArrays(GL_TRIANGLES, static_cast<int>(drawn), static_cast<int>(part));
            drawn += part;
            while (brick < draws_.size() && drawn >= draws_[brick].end_vertex) ++brick;
        }
        glFinish();
        check_interrupt();
        if (progress != nullptr) progress->advance();
    }
}

std::uint64_t GlSliceRenderer::draw_counting(const View& view, Progress* progress) {
    gl::Query query(gl::Query::Kind::samples_passed);
    query.begin();
    draw(view, progress);
    query.end();
    return query.result();
}

}  // namespace lamina
