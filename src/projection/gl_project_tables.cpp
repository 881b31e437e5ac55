// SPDX-License-Identifier: Apache-2.0
#include "projection/gl_project_tables.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "base/enum_words.h"
#include "base/profile.h"
#include "executors/transfer_tables.h"
#include "optics/pieces.h"
#include "optics/segment_integral.h"

namespace lamina {
namespace {

constexpr unsigned table_unit = GlTransferTables::first_free_unit;

gl::TextureFormat format_of(const UniformTable& table) {
    const bool one = table.channels == 1;
    switch (table.request.format) {
        case TableFormat::fixed8:
            return one ? gl::TextureFormat::r8 : gl::TextureFormat::rgba8;
        case TableFormat::fixed16:
            return one ? gl::TextureFormat::r16 : gl::TextureFormat::rgba16;
        case TableFormat::float16:
            return one ? gl::TextureFormat::r16f : gl::TextureFormat::rgba16f;
        case TableFormat::float32:
            return one ? gl::TextureFormat::r32f : gl::TextureFormat::rgba32f;
    }
    unreachable_enum();
}

template <typename Code>
std::vector<Code> to_codes(const std::vector<float>& texels) {
    constexpr double largest = std::numeric_limits<Code>::max();
    std::vector<Code> codes(texels.size());
    std::transform(texels.begin(), texels.end(), codes.begin(), [](float value) {
        return static_cast<Code>(std::lround(static_cast<double>(value) * largest));
    });
    return codes;
}

}  // namespace

GlProjectTables::GlProjectTables(const TransferFunction& transfer_function, const ProjectPlan& plan)
    : plan_(plan) {
    Stage stage("tables");
    single_color_ = glm::vec3(first_color(transfer_function, plan.range.lo, plan.range.hi));
    switch (plan.source) {
        case SegmentSource::constant:
            constant_ = transfer_function.at(plan.range.lo);
            break;
        case SegmentSource::table:
            table_ = plan.table.uniform_table();
            upload(*table_);
            break;
        case SegmentSource::parts:
            if (!plan.single_color) upload_front_weights();
            break;
        case SegmentSource::cut_table:
            intervals_.emplace(transfer_function, plan.range, plan.table.knot_table().get(),
                               plan.table_filtered, 0);
            break;
        case SegmentSource::analytic:
            intervals_.emplace(transfer_function, plan.range, nullptr, false, 0);
            break;
        case SegmentSource::mean:
        case SegmentSource::vertices:
            break;
    }
    build_ms_ = stage.end();
}

void GlProjectTables::upload_front_weights() {
    constexpr int nodes = FrontWeightTable::nodes;
    texture_ = gl::Texture::make_2d(gl::TextureFormat::r32f, nodes, nodes);
    texture_->upload({0, 0, 0, nodes, nodes, 1},
                     std::span<const float>(FrontWeightTable::get().texels()));
    if (plan_.table_filtered) texture_->set_filter(gl::TextureFilter::linear);
}

void GlProjectTables::upload(const UniformTable& table) {
    const int nodes = table.request.scalar_nodes;
    const gl::TextureFormat format = format_of(table);
    texture_ = table.layers > 1 ? gl::Texture::make_3d(format, nodes, nodes, table.layers)
                                : gl::Texture::make_2d(format, nodes, nodes);
    const gl::TexelBox whole{0, 0, 0, nodes, nodes, table.layers};
    switch (table.request.format) {
        case TableFormat::fixed8:
            texture_->upload(whole,
                             std::span<const std::uint8_t>(to_codes<std::uint8_t>(table.texels)));
            break;
        case TableFormat::fixed16:
            texture_->upload(whole,
                             std::span<const std::uint16_t>(to_codes<std::uint16_t>(table.texels)));
            break;
        case TableFormat::float16:
        case TableFormat::float32:
            texture_->upload(whole, std::span<const float>(table.texels));
            break;
    }
    if (plan_.table_filtered) texture_->set_filter(gl::TextureFilter::linear);
}

void GlProjectTables::set_defines(gl::Defines& defines) const {
    defines.set("SOURCE", static_cast<int>(plan_.source));
    if (!plan_.single_color) defines.set("TABLE_COLORED", 1);
    if (plan_.table_filtered) defines.set("TABLE_FILTERED", 1);
    if (plan_.source == SegmentSource::parts) {
        defines.set("CUT", 1);
        defines.set("OPTICS", plan_.single_color ? "float" : "vec4");
        defines.set("FRONT_WEIGHT_NODES", FrontWeightTable::nodes);
    }
    if (intervals_) {
        defines.set("INTERVALS", intervals_->intervals());
        if (intervals_->nodes() > 0) defines.set("TABLE_NODES", intervals_->nodes());
        defines.set("TABLE_LAYERS", plan_.table.request.length_layers);
    }
    if (!table_) return;
    defines.set("TABLE_NODES", table_->request.scalar_nodes);
    defines.set("TABLE_LAYERS", table_->layers);
    defines.set("TABLE_MAPPING", static_cast<int>(table_->request.mapping));
    defines.set("TABLE_STORE", static_cast<int>(table_->request.store));
}

void GlProjectTables::bind(gl::Program& program) const {
    if (plan_.source == SegmentSource::constant) {
        const double extinction = std::min(constant_.extinction, max_shader_extinction);
        program.set("constant_optics", glm::vec4(constant_.color, extinction));
        return;
    }
    if (plan_.single_color) program.set("single_color", single_color_);
    if (intervals_) intervals_->bind(program);
    if (!texture_) return;
    texture_->bind(table_unit);
    program.set(table_ ? "uniform_table" : "front_weights", static_cast<int>(table_unit));
    if (!table_) return;
    program.set("table_scale", table_->scale);
    if (table_->layers > 1) {
        program.set("inverse_first_length", static_cast<float>(table_->inverse_first_length()));
    }
}

}  // namespace lamina
