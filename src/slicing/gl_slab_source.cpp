// SPDX-License-Identifier: Apache-2.0
#include "slicing/gl_slab_source.h"

#include <glad/gl.h>
#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <utility>

#include "base/enum_words.h"
#include "base/profile.h"
#include "executors/gl_optics.h"
#include "executors/lights.h"
#include "executors/transfer_tables.h"
#include "facts/drawn_range.h"
#include "gl/api.h"
#include "optics/pieces.h"
#include "scene/camera.h"
#include "slicing/slab_geometry.h"

namespace lamina {
namespace {

// Texture units; those between the tables and these belong to compositing.
constexpr int distances_unit = 8, gradients_unit = 9;

gl::Texture upload_distances(const OccupiedBricks& bricks) {
    const int width = static_cast<int>(bricks.count[0]), height = static_cast<int>(bricks.count[1]);
    const int depth = static_cast<int>(bricks.count[2]);
    gl::Texture texture = gl::Texture::make_3d(gl::TextureFormat::r8, width, height, depth);
    std::vector<std::uint8_t> distances(bricks.distance.size());
    for (std::size_t i = 0; i < distances.size(); ++i) distances[i] = bricks.distance[i];
    texture.upload({0, 0, 0, width, height, depth}, std::span<const std::uint8_t>(distances));
    return texture;
}

const char* sampling_define(VolumeSampling sampling) {
    switch (sampling) {
        case VolumeSampling::none:
            return "SAMPLING_NONE";
        case VolumeSampling::fetch:
            return "SAMPLING_FETCH";
        case VolumeSampling::filtered:
        case VolumeSampling::hardware:
            return "SAMPLING_FILTER";
    }
    unreachable_enum();
}

// Returns how texels become scalars. Codes of int16 are shifted to begin at 0.
SampleCodes sample_codes(const Volume& volume, const ValueRange& range, const SlicePlan& plan) {
    if (plan.float_texture) return {};
    const double shift = volume.type() == SampleType::int16 ? 32768 : 0;
    return {volume.type() == SampleType::uint8 ? 255.0 : 65535.0, range.lo + shift,
            range.hi > range.lo ? 1 / (range.hi - range.lo) : 0};
}

}  // namespace

gl::Defines segment_defines(const SlicePlan& plan, int intervals, int table_nodes, bool steps) {
    gl::Defines defines;
    defines.set("SAMPLING", sampling_define(plan.sampling));
    if (plan.orthographic) defines.set("ORTHOGRAPHIC", 1);
    if (plan.precise_rays) defines.set("PRECISE_RAYS", 1);
    if (!plan.clip.empty()) defines.set("CLIP_PLANES", static_cast<int>(plan.clip.size()));
    if (plan.single_color) defines.set("SINGLE_COLOR", 1);
    if (plan.sampling == VolumeSampling::none) return defines;
    if (plan.nan_transparent) defines.set("NAN_TRANSPARENT", 1);
    if (plan.nearest) defines.set("NEAREST_LOOKUP", 1);
    if (plan.lighting) set_light_defines(*plan.lighting, defines);
    defines.set("INTERVALS", intervals);
    if (plan.rays.blocks) defines.set("TABLE_BLOCKS", 1);
    if (plan.integrates_cells()) {
        defines.set("EXACT", 1);
        if (plan.rays.alone) defines.set("CUTS_ALONE", 1);
        if (steps) defines.set("STEPS", 1);
        if (plan.float_texture) defines.set("FLOAT_SAMPLES", 1);
        if (plan.words) defines.set("SAMPLE_WORDS", 1);
        // Software, which gets batches, computes both sides of a branch.
        if (plan.batches == 1) defines.set("SKIPS_HIDDEN_PARTS", 1);
    }
    if (!plan.preintegrates()) return defines;
    defines.set("PREINTEGRATED", 1);
    if (plan.linear) {
        defines.set("LINEAR", 1);
        return defines;
    }
    defines.set("TABLE_NODES", table_nodes);
    if (plan.table_filtered) defines.set("TABLE_FILTERED", 1);
    if (!plan.table.request.colored) return defines;
    defines.set("TABLE_COLORED", 1);
    defines.set("TABLE_LAYERS", plan.table.request.length_layers);
    if (plan.table.request.lit) defines.set("TABLE_LIT", 1);
    return defines;
}

GlSlabSource::GlSlabSource(const Volume& volume, const TransferFunction& transfer_function,
                           const Facts& facts, const SlicePlan& plan,
                           std::shared_ptr<const GlVolume> ready)
    : facts_(facts),
      plan_(plan),
      constant_(transfer_function.at(facts.range.lo)),
      volume_(std::move(ready)) {
    facts_.grid = in_units(facts.grid, plan.unit);
    const ValueRange drawn = drawn_range(transfer_function, facts.range);
    single_color_ = first_color(transfer_function, drawn.lo, drawn.hi);
    const bool exact = plan.integrates_cells();
    range_ = exact ? exact_range(transfer_function, facts.range, volume.type()) : drawn;
    Stage tables("tables");
    if (plan_.sampling != VolumeSampling::none) {
        tables_.emplace(transfer_function, range_,
                        plan_.uses_table() ? plan_.table.knot_table().get() : nullptr,
                        plan_.table_filtered, exact ? 0 : sampled_step_advance, plan_.rays.blocks);
    }
    table_ms_ = tables.end();
    take_plan(plan);
    if (plan_.sampling == VolumeSampling::none) return;
    codes_ = sample_codes(volume, range_, plan_);
    if (volume_ && volume_->can_replace(volume, range_, plan_)) return;
    Stage upload("upload");
    volume_ = std::make_shared<GlVolume>(volume, range_, plan_);
    gl::api().Finish();
    upload_ms_ = upload.end();
    gl::check("uploading the volume");
}

void GlSlabSource::take_plan(const SlicePlan& plan) {
    plan_ = plan;
    if (plan_.occupied_only && !distances_)
        distances_.emplace(upload_distances(facts_.occupied_bricks));
}

gl::Defines GlSlabSource::defines() const {
    return tables_
               ? segment_defines(plan_, tables_->intervals(), tables_->nodes(), tables_->steps())
               : segment_defines(plan_, 0, 0, false);
}

void GlSlabSource::bind(gl::Program& program) const {
    program.set("single_color", single_color_);
    if (plan_.ends_early()) program.set("opaque_depth", static_cast<float>(plan_.opaque_depth));
    if (plan_.occupied_only) {
        distances_->bind(distances_unit);
        program.set("distances", distances_unit);
        program.set(
            "last_distance",
            glm::vec3(distances_->width(), distances_->height(), distances_->depth()) - 1.0f);
    }
    if (tables_) {
        tables_->bind(program);
        program.set("volume", GlTransferTables::first_free_unit);
        if (plan_.lighting) bind_lights(program);
        return;
    }
    const double extinction = std::min(constant_.extinction, max_shader_extinction);
    const auto rounded = static_cast<float>(extinction);
    program.set("constant_optics", glm::vec4(glm::vec3(constant_.color), rounded));
    program.set("constant_extinction_low", static_cast<float>(extinction - double{rounded}));
}

void GlSlabSource::bind_lights(gl::Program& program) const {
    set_lights(*plan_.lighting, facts_.grid.step, program);
    const SmallestGradient smallest = smallest_gradient_of(*plan_.lighting);
    program.set("smallest_gradient", smallest.mantissa);
    program.set("smallest_exponent", smallest.exponent);
    program.set("gradients", gradients_unit);
    glm::vec3 spacing;
    for (int axis = 0; axis < 3; ++axis) {
        const double length = glm::length(facts_.grid.step[static_cast<std::size_t>(axis)]);
        spacing[axis] = static_cast<float>(length);
    }
    program.set("spacing", spacing);
    if (!plan_.integrates_cells()) return;
    program.set("most_bend", static_cast<float>(plan_.most_bend));
    set_light_cuts(*plan_.lighting, program);
}

void GlSlabSource::set_real(gl::Program& program, const char* name, const glm::dvec3& value) const {
    if (plan_.precise_rays) {
        program.set(name, value);
    } else {
        program.set(name, glm::vec3(value));
    }
}

void GlSlabSource::set_view(gl::Program& program, const View& view, const Slabs& slabs) const {
    const glm::vec2 size(static_cast<float>(view.width), static_cast<float>(view.height));
    program.set("image_middle", 0.5f * size);
    program.set("normalisation",
                glm::vec2(codes_.largest * codes_.scale, -codes_.base * codes_.scale));
    program.set("largest_code", static_cast<float>(codes_.largest));
    program.set("code_normalisation", glm::vec2(codes_.base, codes_.scale));
    const double thickness = (slabs.far - slabs.near) / slabs.count;
    if (plan_.precise_rays) {
        program.set("slab_thickness", thickness);
    } else {
        program.set("slab_thickness", static_cast<float>(thickness));
    }
    // shaders/slicing/ray.glsl counts depth from the front of the nearest slab.
    const bool perspective = view.projection == Projection::perspective;
    program.set("pixel_size", perspective ? static_cast<float>(view.pixel) : 0.0f);
    const glm::dvec3 column = facts_.grid.direction_to_index(view.pixel * view.right);
    const glm::dvec3 row = facts_.grid.direction_to_index(-view.pixel * view.up);
    const double spread = perspective ? slabs.near : 1;
    set_real(program, "origin_column", spread * column);
    set_real(program, "origin_row", spread * row);
    set_real(program, "direction_middle", facts_.grid.direction_to_index(view.forward));
    set_real(program, "direction_column", perspective ? column : glm::dvec3(0));
    set_real(program, "direction_row", perspective ? row : glm::dvec3(0));
}

void GlSlabSource::set_clip(gl::Program& program, const glm::dvec3& first) const {
    if (plan_.clip.empty()) return;
    std::vector<glm::dvec4> planes;
    for (const IndexPlane& plane : plan_.clip)
        planes.emplace_back(plane.normal, plane.seen_from(first).offset);
    if (plan_.precise_rays) {
        program.set("clip_planes", std::span<const glm::dvec4>(planes));
    } else {
        const std::vector<glm::vec4> rounded(planes.begin(), planes.end());
        program.set("clip_planes", std::span<const glm::vec4>(rounded));
    }
}

void GlSlabSource::set_brick(gl::Program& program, const View& view, const Slabs& slabs,
                             std::size_t brick) const {
    const TextureBrick& texture = plan_.bricks[brick];
    const glm::dvec3 first{texture.first[0], texture.first[1], texture.first[2]};
    const IndexBox box = box_of(texture, facts_.grid);
    set_real(program, "origin_middle",
             facts_.grid.to_index(view.eye + slabs.near * view.forward) - first);
    set_clip(program, first);
    if (plan_.occupied_only) program.set("first_sample", glm::vec3(first));
    program.set("box_min", glm::vec3(box.min - first));
    program.set("box_max", glm::vec3(box.max - first));
    const glm::dvec3 end(glm::vec3(box.max - first));  // rounded as in shaders/slicing/ray.glsl
    program.set("last_face", glm::vec3(last_face_of(end, first, facts_.grid)));
    program.set("last_sample",
                glm::vec3(glm::dvec3(texture.size[0], texture.size[1], texture.size[2]) - 1.0));
    if (tables_) volume_->bind(brick, GlTransferTables::first_free_unit);
    if (plan_.lighting) volume_->gradients()[brick].bind(gradients_unit);
}

IndexBox GlSlabSource::drawn_box(std::size_t brick) const {
    IndexBox box = box_of(plan_.bricks[brick], facts_.grid);
    box.min = glm::max(box.min, plan_.drawn.min);
    box.max = glm::min(box.max, plan_.drawn.max);
    return box;
}

}  // namespace lamina
