// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "executors/gl_code_tree.h"
#include "executors/gl_pixels.h"
#include "gl/program.h"
#include "gl/timeline.h"
#include "projection/gl_project_renderer.h"
#include "projection/project_renderer.h"
#include "projection/tet_projector.h"
#include "projection/tile_lists.h"

namespace lamina {

// Returns the definitions of projection/codes.comp.
gl::Defines tet_code_defines(const ProjectPlan& plan, const GlProjectTables& tables);

// Draws a mesh on codes, for Target::emulated and ProjectDither::after_blend, in the current OpenGL
// context, which must outlive it. A compute shader composites the cell fragments that are listed
// for each tile of the picture, in visibility order.
class GlTetCodes : public ProjectRenderer {
  public:
    // The plan must have Blending::registers. The mesh must outlive the renderer.
    GlTetCodes(const SceneMesh& mesh, const TransferFunction& transfer_function,
               const ProjectPlan& plan, int width, int height,
               std::shared_ptr<VisibilityOrder> order = nullptr);

    void draw(const View& view, Progress* progress = nullptr) override;
    int step_count() const override;
    using FrameRenderer::read;
    void read(Image& image) const override;
    std::map<std::string, double> stages_ms() const override;
    ProjectReuse reusable() const override { return {order_, nullptr}; }

  private:
    struct Leaves;

    void set_view(const View& view);
    // Composites cell fragments onto the picture, or onto the opacity of a leaf.
    void composite(const TetProjector& projector, const DrawOrder<CellFragment>& cell_fragments,
                   const GlPixels& picture, const std::function<void()>& batch_done);
    void list(const TetProjector& projector, const DrawOrder<CellFragment>& batch);
    void upload(std::size_t count);
    void dispatch();

    int width_, height_;
    std::optional<GlProjectTables> tables_;  // none if nothing is visible
    std::optional<gl::Program> program_;
    StoredGradients gradients_;  // empty if nothing is lit
    GlPixels picture_;
    std::optional<GlCodeTree> tree_;  // if the plan has one
    int most_of_list_ = 0;            // entries of a tile's list that a dispatch draws
    gl::Timeline timeline_;
    double list_ms_ = 0;
    // The following belong to a batch.
    std::vector<SilhouetteRecord> records_;
    std::vector<GradientRecord> gradient_records_;
    std::vector<PixelArea> areas_;
    TileLists lists_;
    gl::Buffer record_buffer_, gradient_buffer_, tile_buffer_, entry_buffer_;
};

}  // namespace lamina
