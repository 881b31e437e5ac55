// SPDX-License-Identifier: Apache-2.0
#include "executors/gl_optics.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "executors/lights.h"
#include "optics/ray_lights.h"

namespace lamina {
namespace {

enum TextureUnit {
    intervals_unit,
    interval_starts_unit,
    knot_table_unit,
    front_parts_unit = GlTransferTables::lit_unit
};
constexpr unsigned block_binding = 4;
static_assert(knot_table_unit < GlTransferTables::first_free_unit);

// Uploads a table. Texels of a coloured table are emission and mean extinction, and each length is
// a layer; those of a table without colour are mean extinction alone.
gl::Texture upload_table(const KnotTable& table) {
    const std::size_t nodes = table.nodes.size();
    const int size = static_cast<int>(nodes);
    if (!table.request.colored) {
        gl::Texture texture = gl::Texture::make_2d(gl::TextureFormat::r32f, size, size);
        texture.upload({0, 0, 0, size, size, 1}, std::span<const float>(table.mean_extinction));
        return texture;
    }
    const int layers = static_cast<int>(table.lengths.size());
    gl::Texture texture = gl::Texture::make_3d(gl::TextureFormat::rgba32f, size, size, layers);
    std::vector<float> texels(4 * nodes * nodes);
    for (int layer = 0; layer < layers; ++layer) {
        const float* const emission =
            table.emission.data() + 3 * nodes * nodes * static_cast<std::size_t>(layer);
        for (std::size_t i = 0; i < nodes * nodes; ++i) {
            std::copy_n(emission + 3 * i, 3, texels.begin() + static_cast<std::ptrdiff_t>(4 * i));
            texels[4 * i + 3] = table.mean_extinction[i];
        }
        texture.upload({0, 0, layer, size, size, 1}, std::span<const float>(texels));
    }
    return texture;
}

gl::Texture upload_intervals(const ShaderIntervals& intervals) {
    constexpr int columns = ShaderIntervals::columns, rows = ShaderIntervals::rows;
    const int groups = (intervals.count + columns - 1) / columns;
    const int width = std::min(intervals.count, columns);
    gl::Texture texture = gl::Texture::make_2d(gl::TextureFormat::rgba32f, width, rows * groups);
    for (int row = 0; row < rows * groups; ++row) {
        const int first = row / rows * columns, count = std::min(intervals.count - first, width);
        const int texel = row % rows * intervals.count + first;
        texture.upload({0, row, 0, count, 1, 1}, std::span<const float>(intervals.texels)
                                                     .subspan(4 * static_cast<std::size_t>(texel),
                                                              4 * static_cast<std::size_t>(count)));
    }
    return texture;
}

gl::Texture upload_front_parts(const KnotTable& table) {
    const int size = static_cast<int>(table.nodes.size());
    const int layers = static_cast<int>(table.lengths.size());
    gl::Texture texture = gl::Texture::make_3d(gl::TextureFormat::rgba32f, size, size, layers);
    texture.upload({0, 0, 0, size, size, layers}, std::span<const float>(table.front_parts));
    return texture;
}

// Returns the storage block of shaders/optics/intervals.glsl.
gl::Buffer make_block(const ShaderIntervals& intervals) {
    std::vector<float> block(intervals.starts.begin(), intervals.starts.end());
    block.reserve(block.size() + intervals.texels.size());
    for (int interval = 0; interval < intervals.count; ++interval) {
        for (int row = 0; row < ShaderIntervals::rows; ++row) {
            const auto texel = static_cast<std::size_t>(row * intervals.count + interval);
            const auto from = std::span(intervals.texels).subspan(4 * texel, 4);
            block.insert(block.end(), from.begin(), from.end());
        }
    }
    return gl::Buffer(std::span(block));
}

bool is_gray(const Light& light) {
    return light.color.x == light.color.y && light.color.x == light.color.z;
}

// Returns a light for shaders/optics/lighting.glsl: the direction to it along `axes`, or (0, 0, 0,
// 1) for a headlight.
glm::vec4 shader_direction(const Light& light, const std::array<glm::dvec3, 3>& axes) {
    if (!light.direction) return {0, 0, 0, 1};
    const glm::dvec3 to_light = unit_vector(*light.direction);
    glm::dvec3 along(0);
    for (int axis = 0; axis < 3; ++axis)
        along[axis] = glm::dot(to_light, unit_vector(axes[static_cast<std::size_t>(axis)]));
    return {glm::vec3(along), 0};
}

}  // namespace

GlTransferTables::GlTransferTables(const TransferFunction& transfer_function,
                                   const ValueRange& range, const KnotTable* table, bool filtered,
                                   double step_advance, bool block) {
    std::vector<KnotTable::Anchor> anchors;
    if (table != nullptr) {
        anchors = table->anchors;
        knot_table_ = upload_table(*table);
        if (table->request.lit) front_parts_.emplace(upload_front_parts(*table));
        if (filtered) knot_table_.set_filter(gl::TextureFilter::linear);
        if (filtered && front_parts_) front_parts_->set_filter(gl::TextureFilter::linear);
        node_count_ = static_cast<int>(table->nodes.size());
        const TableRequest& request = table->request;
        if (request.max_length > 0) {
            layers_per_length_ =
                static_cast<float>((request.length_layers - 1) / request.max_length);
        }
    }
    const ShaderIntervals intervals = make_intervals(
        pieces_between(transfer_function, range.lo, range.hi, false), range, anchors, step_advance);
    interval_count_ = intervals.count;
    steps_ = intervals.steps;
    if (block) {
        block_ = make_block(intervals);
        return;
    }
    intervals_ = upload_intervals(intervals);
    interval_starts_ =
        gl::Texture::make_2d(gl::TextureFormat::r32f, ShaderIntervals::start_count, 1);
    interval_starts_.upload({0, 0, 0, ShaderIntervals::start_count, 1, 1},
                            std::span<const float>(intervals.starts));
}

void GlTransferTables::bind(gl::Program& program) const {
    if (block_.byte_count() > 0) {
        block_.bind_storage(block_binding);
    } else {
        intervals_.bind(intervals_unit);
        interval_starts_.bind(interval_starts_unit);
        program.set("intervals", intervals_unit);
        program.set("interval_starts", interval_starts_unit);
    }
    if (node_count_ == 0) return;
    knot_table_.bind(knot_table_unit);
    program.set("knot_table", knot_table_unit);
    program.set("layers_per_length", layers_per_length_);
    if (!front_parts_) return;
    front_parts_->bind(front_parts_unit);
    program.set("front_parts", front_parts_unit);
}

void set_light_defines(const Lighting& lighting, gl::Defines& defines) {
    defines.set("LIGHTS", static_cast<int>(lighting.lights.size()));
    if (std::ranges::all_of(lighting.lights, is_gray)) defines.set("GRAY_LIGHT", 1);
    if (lighting.specular > 0) defines.set("HIGHLIGHTS", 1);
}

void set_lights(const Lighting& lighting, const std::array<glm::dvec3, 3>& axes,
                gl::Program& program) {
    std::vector<glm::vec4> directions, colors;
    for (const Light& light : lighting.lights) {
        directions.push_back(shader_direction(light, axes));
        colors.emplace_back(glm::vec3(light.color), 0);
    }
    program.set("light_terms",
                glm::vec3(glm::dvec3(lighting.ambient - 1, lighting.diffuse, lighting.specular)));
    program.set("half_power", static_cast<float>(lighting.power / 2));
    program.set("light_directions", std::span<const glm::vec4>(directions));
    program.set("light_colors", std::span<const glm::vec4>(colors));
}

void set_light_cuts(const Lighting& lighting, gl::Program& program) {
    const LightCuts cuts = light_cuts(lighting);
    program.set("hidden_limits",
                glm::vec4(cuts.highlight_effect, cuts.most_turn * cuts.most_turn, cuts.plain_effect,
                          cuts.most_plain_turn * cuts.most_plain_turn));
}

}  // namespace lamina
