// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "base/progress.h"
#include "executors/gl_fixed_tree.h"
#include "gl/framebuffer.h"
#include "gl/timeline.h"
#include "lamina/image.h"
#include "slicing/gl_shader_tree.h"
#include "slicing/gl_slab_pass.h"
#include "slicing/gl_slab_source.h"
#include "slicing/slice_renderer.h"

namespace lamina {

// Draws a volume as the plan says, in the current OpenGL context, which must outlive the renderer.
class GlSliceRenderer : public SliceRenderer {
  public:
    // Uploads the volume, builds the tables and compiles the programs that the context lacks;
    // errors of OpenGL are Errors. `ready`: volume() of another renderer, which is used if it has
    // the right form.
    GlSliceRenderer(const Volume& volume, const TransferFunction& transfer_function,
                    const Facts& facts, const SlicePlan& plan, const Capabilities& capabilities,
                    int width, int height, std::shared_ptr<const VolumeTextures> ready = nullptr);
    GlSliceRenderer(const GlSliceRenderer&) = delete;  // its parts refer to its plan
    GlSliceRenderer& operator=(const GlSliceRenderer&) = delete;

    bool take(const Plan& plan) override;
    void draw(const View& view, Progress* progress = nullptr) override;
    int step_count() const override;
    using FrameRenderer::read;
    void read(Image& image) const override;
    std::map<std::string, double> stages_ms() const override;

    SliceParts parts() const override { return {nullptr, volume()}; }
    std::shared_ptr<const VolumeTextures> volume() const {
        return source_ ? source_->volume() : kept_;
    }

    double upload_ms() const { return source_ ? source_->upload_ms() : 0; }
    double table_ms() const { return source_ ? source_->table_ms() : 0; }
    double geometry_ms() const { return geometry_ms_; }  // of the last frame
    double draw_ms() const { return draw_ms_; }

  private:
    void draw_straight(Progress* progress);

    SlicePlan plan_;
    Grid grid_;
    gl::Framebuffer target_;
    // All are empty if nothing is visible. Otherwise there are slabs, which are blended directly or
    // are the leaves of a tree of fixed-point nodes, or there is a tree that marches the slabs.
    std::optional<GlSlabSource> source_;
    std::optional<GlSlabPass> slabs_;
    std::optional<GlFixedTree> fixed_tree_;
    std::optional<GlShaderTree> shader_tree_;
    gl::Timeline timeline_;
    std::shared_ptr<const VolumeTextures> kept_;  // kept for another renderer if this one needs
                                                  // none
    double geometry_ms_ = 0, draw_ms_ = 0;
};

}  // namespace lamina
