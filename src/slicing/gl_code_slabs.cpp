// SPDX-License-Identifier: Apache-2.0
#include "slicing/gl_code_slabs.h"

#include <glad/gl.h>

#include <span>
#include <utility>

#include "compositing/codes.h"
#include "slicing/gl_slice_renderer.h"

namespace lamina {
namespace {

constexpr unsigned picture_binding = 0;
constexpr int ranks_width = 256;  // ranks in a row, as shaders/slicing/dither_ranks.glsl reads them

}  // namespace

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

GlCodeSlabs::GlCodeSlabs(const GlSlabSource& source, const SlicePlan& plan,
                         const Capabilities& capabilities, int width, int height)
    : source_(source),
      plan_(plan),
      height_(height),
      defines_(wanted_defines()),
      program_("slicing/codes.comp", defines_),
      march_(source, plan),
      picture_(packing_of(plan), width, height),
      pace_(rows_of_band(height, plan.batches,
                         capabilities.max_storage_bytes / (4 * std::int64_t{picture_.row_words()})),
            RowBand::tile_rows, !capabilities.software) {
    if (plan_.dither) ranks_ = upload_ranks(*plan_.dither);
    if (!plan_.tree) return;
    tree_.emplace(plan_, TreeShape(plan_.tree->factors, plan_.slabs), source_.single_color(), width,
                  height);
}

gl::Defines GlCodeSlabs::wanted_defines() const {
    gl::Defines defines = slab_defines(plan_, source_.defines());
    set_rays(defines, plan_.rays);
    return defines;
}

void GlCodeSlabs::take_plan() {
    gl::Defines wanted = wanted_defines();
    if (wanted == defines_) return;
    program_ = gl::Program("slicing/codes.comp", wanted);
    defines_ = std::move(wanted);
}

void GlCodeSlabs::set_view(const View& view, const Slabs& slabs) {
    march_.set_view(view, slabs, plan_.order, program_);
}

void GlCodeSlabs::draw(Progress* progress) {
    pace_.begin_frame();
    if (tree_) {
        tree_->draw(*this, picture_, progress);
    } else {
        draw_slabs({0, plan_.slabs}, picture_, progress);
    }
    march_.end_frame();
}

void GlCodeSlabs::draw(const SampleSpan& span, const GlPixels& opacity, double depth_scale) {
    program_.set("depth_scale", depth_scale);
    draw_slabs(span, opacity, nullptr);
}

void GlCodeSlabs::draw_slabs(const SampleSpan& span, const GlPixels& picture, Progress* progress) {
    source_.bind(program_);
    program_.set("seed", static_cast<int>(plan_.emulation->seed));
    if (plan_.dither) {
        program_.set("dither_ranks", ranks_unit);
        ranks_.bind(ranks_unit);
    }
    program_.set("output_row", picture.row_words());
    const std::vector<GlMarch::Part>& parts = march_.parts_of(span);
    draw_bands(height_, pace_, [&](const RowBand& band) {
        picture.bind(picture_binding, band.first_row, band.rows);
        program_.set("output_begin", -band.first_row * picture.row_words());
        for (const GlMarch::Part& part : parts) march_.draw(part, band, program_);
        drawn_.end_step();
        if (progress != nullptr) progress->advance(band.rows);
    });
}

void GlCodeSlabs::read(Image& image) const {
    picture_.read(image, largest_code(plan_.code_bits()));
}

}  // namespace lamina
