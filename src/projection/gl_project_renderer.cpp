// SPDX-License-Identifier: Apache-2.0
// Draws a frame of a mesh with OpenGL:
//   1. Sort the visible cell fragments into visibility order.
//   2. For each batch (GlTetStream): write triangles that cover the cell fragments, on all cores.
//   3. Draw them: projection/tet.frag finds each pixel's colour and opacity, in the program of the
//      FragmentKind, and blending composites them in order. Meanwhile the next batch is written.
// With a compositing tree, steps 2 and 3 draw each leaf, and GlFixedTree composites the leaves.
#include "projection/gl_project_renderer.h"

#include <glad/gl.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "base/enum_words.h"
#include "base/profile.h"
#include "executors/gl_compositing.h"
#include "executors/gl_optics.h"
#include "executors/transfer_tables.h"
#include "gl/api.h"
#include "optics/pieces.h"
#include "optics/segment_integral.h"
#include "projection/fan_geometry.h"
#include "scene/camera.h"

namespace lamina {
namespace {

// Steps of the rasteriser's sub-pixel grid by which surround() enlarges silhouettes.
constexpr double margin_steps = 2;

// The attributes of the vertex shaders, in the order of their locations.
constexpr std::array silhouette_attributes{
    GlTetStream::Attribute{2, offsetof(SilhouetteVertex, position), false},
    GlTetStream::Attribute{1, offsetof(SilhouetteVertex, record), true}};
constexpr std::array fan_attributes{GlTetStream::Attribute{2, offsetof(FanVertex, position), false},
                                    GlTetStream::Attribute{3, offsetof(FanVertex, inverse), false},
                                    GlTetStream::Attribute{4, offsetof(FanVertex, front), false},
                                    GlTetStream::Attribute{4, offsetof(FanVertex, back), false},
                                    GlTetStream::Attribute{2, offsetof(FanVertex, scalars), false},
                                    GlTetStream::Attribute{1, offsetof(FanVertex, tet), true}};

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

// Draws the leaves of a tree by calling a function.
template <typename DrawLeaf>
struct TetLeaves : TreeLeaves {
    explicit TetLeaves(DrawLeaf& function) : draw_leaf(function) {}
    void draw(const SampleSpan& span, double depth_scale) override { draw_leaf(span, depth_scale); }
    DrawLeaf& draw_leaf;
};

}  // namespace

bool has_program(const ProjectPlan& plan, FragmentKind kind) {
    switch (kind) {
        case FragmentKind::thin:
            return plan.plain && plan.source == SegmentSource::parts && !plan.single_color;
        case FragmentKind::plain:
            return plan.plain;
        case FragmentKind::careful:
            return plan.geometry == ProjectGeometry::silhouette;
    }
    unreachable_enum();
}

gl::Defines project_defines(const ProjectPlan& plan, FragmentKind kind) {
    gl::Defines defines;
    if (plan.geometry == ProjectGeometry::triangles) defines.set("FAN", 1);
    if (kind == FragmentKind::thin) defines.set("THIN", 1);
    if (kind == FragmentKind::careful) defines.set("CAREFUL", 1);
    if (!plan.tree.empty()) defines.set("OPACITY_ONLY", 1);
    if (plan.source != SegmentSource::constant) defines.set("SCALARS", 1);
    if (plan.windowed) defines.set("WINDOWED", 1);
    if (plan.blocks) defines.set("TABLE_BLOCKS", 1);
    if (kind == FragmentKind::careful && plan.source != SegmentSource::parts)
        defines.set("EXACT_SEGMENTS", 1);
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
        return defines;
    }
    set_compositing(defines, plan);
    if (plan.dither == ProjectDither::alpha) defines.set("DITHER_ALPHA", 1);
    return defines;
}

void set_lit_view(const Lighting& lighting, const StoredGradients& gradients, double most_bend,
                  gl::Program& program) {
    set_lights(lighting, world_axes, program);
    set_light_cuts(lighting, program);
    program.set("light_limits", glm::vec2(gradients.smallest_square(lighting), most_bend));
}

void set_projection(const ProjectPlan& plan, const StoredGradients& gradients, const View& view,
                    gl::Program& program) {
    const glm::vec2 size(view.width, view.height);
    program.set("image_middle", 0.5f * size);
    program.set("pixel_size", static_cast<float>(seeing_in_units(view, plan.unit).pixel));
    if (plan.geometry == ProjectGeometry::silhouette) {
        program.set("ray_perturbation", ray_perturbation(view));
        // In perspective views depth is stored as -1 / z, which is linear in the window.
        const double near =
            view.projection == Projection::perspective ? -1 / plan.near_depth : plan.near_depth;
        program.set("near_depth", static_cast<float>(near));
    }
    if (plan.in_codes()) program.set("seed", static_cast<int>(plan.seed));
    if (!plan.lighting) return;
    set_lit_view(*plan.lighting, gradients, plan.most_bend, program);
    const auto axis = [](const glm::dvec3& v) { return glm::vec4(glm::vec3(v), 0); };
    const std::array axes{axis(view.right), axis(view.up), axis(view.forward)};
    program.set("view_axes", std::span<const glm::vec4>(axes));
}

GlProjectTables::GlProjectTables(const TransferFunction& transfer_function, const ProjectPlan& plan)
    : plan_(plan),
      source_(plan.walk && plan.source == SegmentSource::analytic ? SegmentSource::parts
                                                                  : plan.source),
      single_color_(first_color(transfer_function, plan.range.lo, plan.range.hi)) {
    switch (source_) {
        case SegmentSource::constant:
            constant_ = transfer_function.at(plan.range.lo);
            break;
        case SegmentSource::table:
            table_ = plan.table.uniform_table();
            upload(*table_);
            break;
        case SegmentSource::parts:
            // A walk cuts segments to pieces that need no table.
            if (plan.walk) {
                intervals_.emplace(transfer_function, plan.range, nullptr, false, 0, plan.blocks);
            } else if (!plan.single_color) {
                constexpr int nodes = FrontWeightTable::nodes;
                texture_ = gl::Texture::make_2d(gl::TextureFormat::r32f, nodes, nodes);
                texture_->upload({0, 0, 0, nodes, nodes, 1},
                                 std::span<const float>(FrontWeightTable::get().texels()));
            }
            break;
        case SegmentSource::cut_table:
            intervals_.emplace(transfer_function, plan.range, plan.table.knot_table().get(),
                               plan.table_filtered, 0, plan.blocks);
            break;
        case SegmentSource::analytic:
            intervals_.emplace(transfer_function, plan.range, nullptr, false, 0, plan.blocks);
            break;
        case SegmentSource::mean:
        case SegmentSource::vertices:
            break;
    }
    if (texture_ && plan.table_filtered) texture_->set_filter(gl::TextureFilter::linear);
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
        case TableFormat::float16:  // OpenGL converts float32 to half
        case TableFormat::float32:
            texture_->upload(whole, std::span<const float>(table.texels));
            break;
    }
}

void GlProjectTables::set_defines(gl::Defines& defines) const {
    defines.set("SOURCE", static_cast<int>(source_));
    if (!plan_.single_color) defines.set("TABLE_COLORED", 1);
    if (plan_.table_filtered) defines.set("TABLE_FILTERED", 1);
    if (source_ == SegmentSource::parts) {
        defines.set("OPTICS", plan_.single_color ? "float" : "vec4");
        if (plan_.walk) {
            defines.set("THIN", 1);
        } else {
            defines.set("CUT", 1);
            defines.set("FRONT_WEIGHT_NODES", FrontWeightTable::nodes);
        }
    }
    // At most one of `intervals_` and `table_` is set.
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
    if (source_ == SegmentSource::constant) {
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

GlProjectRenderer::GlProjectRenderer(const SceneMesh& mesh,
                                     const TransferFunction& transfer_function,
                                     const ProjectPlan& plan, const Capabilities& capabilities,
                                     int width, int height, std::shared_ptr<VisibilityOrder> order,
                                     std::shared_ptr<GlTetStream> stream)
    : ProjectRenderer(mesh, transfer_function, plan, std::move(order)),
      margin_(margin_steps / std::exp2(capabilities.subpixel_bits)),
      target_(gl::Texture::make_2d(color_format(plan), width, height)) {
    if (plan_.nothing_visible) return;
    Stage tables("tables");
    tables_.emplace(transfer_function_, plan_);
    table_ms_ = tables.end();
    for (std::size_t i = 0; i < fragment_kinds; ++i) {
        const auto kind = static_cast<FragmentKind>(i);
        if (!has_program(plan_, kind)) continue;
        gl::Defines defines = project_defines(plan_, kind);
        tables_->set_defines(defines);
        programs_[i].emplace(is_fan() ? "projection/fan.vert" : "projection/silhouette.vert",
                             "projection/tet.frag", defines);
    }
    if (visible_->count() == 0) return;
    make_stream(std::move(stream));
    if (const std::optional<TreeShape> shape = tree_shape())
        tree_.emplace(plan_, *shape, tables_->single_color(), target_.width(), target_.height());
}

void GlProjectRenderer::make_stream(std::shared_ptr<GlTetStream> ready) {
    const auto cell_fragments = static_cast<std::size_t>(visible_->count());
    const bool fan = is_fan();
    const TetGeometry::Size size =
        fan ? FanGeometry::largest_size()
            : SilhouetteGeometry::largest_size(plan_.lighting.has_value());
    stream_ = std::move(ready);
    if (!stream_ || !stream_->can_replace(size, cell_fragments)) {
        stream_ = fan ? std::make_shared<GlTetStream>(size, fan_attributes, cell_fragments)
                      : std::make_shared<GlTetStream>(size, silhouette_attributes, cell_fragments);
    }
}

int GlProjectRenderer::step_count() const {
    if (tree_) return tree_->step_count();
    return stream_
               ? static_cast<int>(stream_->batch_count(static_cast<std::size_t>(visible_->count())))
               : 0;
}

void GlProjectRenderer::draw(const View& view, Progress* progress) {
    target_.bind();
    target_.clear(glm::vec4(0));
    order_ms_ = draw_ms_ = 0;
    tets_drawn_ = 0;
    if (!stream_) return;
    Stage ordering("order");
    const DrawOrder<CellFragment> cell_fragments =
        visible_->sorted(*order_, view, plan_.scattered, plan_.solve_rings);
    order_ms_ = ordering.end();
    Stage drawing("draw");
    for (auto& program : programs_) {
        if (program) set_view(*program, view);
    }
    draw_cell_fragments(cell_fragments, seeing_in_units(view, plan_.unit), progress);
    Stage finishing("finish");
    gl::api().Finish();
    finishing.end();
    drawing.count("tets", static_cast<double>(tets_drawn_));
    draw_ms_ = drawing.end();
    stream_->end_frame();
}

void GlProjectRenderer::set_view(gl::Program& program, const View& view) const {
    tables_->bind(program);
    set_projection(plan_, gradients_, view, program);
    program.set("image_size", glm::vec2(view.width, view.height));
    if (plan_.in_codes()) program.set("image_rows", view.height);
}

void GlProjectRenderer::draw_cell_fragments(const DrawOrder<CellFragment>& cell_fragments,
                                            const View& view, Progress* progress) {
    std::optional<FanGeometry> fans;
    std::optional<SilhouetteGeometry> silhouettes;
    if (is_fan()) {
        fans.emplace(mesh_, transfer_function_, plan_, view);
    } else {
        silhouettes.emplace(
            TetProjector({mesh_.mesh, mesh_.scalar.values, plan_.range, pieces_, WindowView(view),
                          plan_.near_depth, margin_, gradients_.at_points}));
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
        // The programs draw opacity alone (OPACITY_ONLY).
        const auto draw_leaf = [&](const SampleSpan& span, double depth_scale) {
            for (gl::Program* program : programs)
                program->set("depth_scale", static_cast<float>(depth_scale));
            const CompositingState state(plan_, true);
            tets_drawn_ += stream_->draw(
                geometry, cell_fragments_of_leaf(cell_fragments, span, visible_->count()),
                target_.height(), programs, [] {});
        };
        TetLeaves leaves(draw_leaf);
        tree_->draw(leaves, target_, progress);
        return;
    }
    const CompositingState state(plan_, false);
    tets_drawn_ = stream_->draw(geometry, cell_fragments, target_.height(), programs, [&] {
        if (progress != nullptr) progress->advance();
    });
}

void GlProjectRenderer::read(Image& image) const {
    target_.read_back(image);
}

std::map<std::string, double> GlProjectRenderer::stages_ms() const {
    // The geometry of a batch is written while the batch before is drawn, so these times overlap.
    return {{"tables", table_ms_},
            {"order", order_ms_},
            {"geometry", stream_ ? stream_->write_ms() : 0},
            {"draw", draw_ms_}};
}

}  // namespace lamina
