// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "executors/gl_compositing.h"
#include "executors/gl_optics.h"
#include "gl/framebuffer.h"
#include "gl/program.h"
#include "gl/texture.h"
#include "projection/gl_tet_stream.h"
#include "projection/project_renderer.h"

namespace lamina {

// Tells whether the plan needs a program for this kind; otherwise a later kind's program draws it.
bool has_program(const ProjectPlan& plan, FragmentKind kind);
// Returns the definitions of projection/tet.frag and its vertex shader, or of codes.comp, except
// for the tables.
gl::Defines project_defines(const ProjectPlan& plan, FragmentKind kind);

// Sets the uniforms of a lit program, except view_axes.
void set_lit_view(const Lighting& lighting, const StoredGradients& gradients, double most_bend,
                  gl::Program& program);

// Sets the uniforms of projection/silhouette.glsl or fan.glsl, of light and of random numbers.
void set_projection(const ProjectPlan& plan, const StoredGradients& gradients, const View& view,
                    gl::Program& program);

// The transfer function in the form that the fragments of tets read
// (shaders/projection/tet_color.glsl). The plan must outlive it.
class GlProjectTables {
  public:
    GlProjectTables(const TransferFunction& transfer_function, const ProjectPlan& plan);

    void set_defines(gl::Defines& defines) const;
    void bind(gl::Program& program) const;  // textures and uniforms
    const glm::vec3& single_color() const { return single_color_; }
    int intervals() const { return intervals_ ? intervals_->intervals() : 0; }

  private:
    void upload(const UniformTable& table);

    const ProjectPlan& plan_;
    // The plan's, but walks cut segments to pieces in place of integrating them at once (analytic).
    SegmentSource source_;
    glm::vec3 single_color_;
    OpticalProperties constant_;
    std::shared_ptr<const UniformTable> table_;
    // Holds table_, or FrontWeightTable for SegmentSource::parts.
    std::optional<gl::Texture> texture_;
    std::optional<GlTransferTables> intervals_;  // for SegmentSource::analytic and ::cut_table
};

// Draws a mesh as the plan says, in the current OpenGL context, which must outlive the renderer.
class GlProjectRenderer : public ProjectRenderer {
  public:
    // Uses `order` and `stream`, from another renderer of the mesh, if they fit, or else builds its
    // own. Throws Error if OpenGL fails. The mesh must outlive the renderer.
    GlProjectRenderer(const SceneMesh& mesh, const TransferFunction& transfer_function,
                      const ProjectPlan& plan, const Capabilities& capabilities, int width,
                      int height, std::shared_ptr<VisibilityOrder> order = nullptr,
                      std::shared_ptr<GlTetStream> stream = nullptr);

    void draw(const View& view, Progress* progress = nullptr) override;
    int step_count() const override;
    using FrameRenderer::read;
    void read(Image& image) const override;
    std::map<std::string, double> stages_ms() const override;
    ProjectReuse reusable() const override { return {order_, stream_}; }

  private:
    void make_stream(std::shared_ptr<GlTetStream> ready);
    void set_view(gl::Program& program, const View& view) const;
    void draw_cell_fragments(const DrawOrder<CellFragment>& cell_fragments, const View& view,
                             Progress* progress);

    double margin_;  // pixels by which silhouettes are enlarged
    gl::Framebuffer target_;
    std::optional<GlProjectTables> tables_;                            // none if nothing is visible
    std::array<std::optional<gl::Program>, fragment_kinds> programs_;  // by FragmentKind
    std::shared_ptr<GlTetStream> stream_;
    std::optional<GlFixedTree> tree_;  // if the plan has one
};

}  // namespace lamina
