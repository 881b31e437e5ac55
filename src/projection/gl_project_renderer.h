// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/progress.h"
#include "executors/gl_compositing.h"
#include "gl/framebuffer.h"
#include "gl/program.h"
#include "lamina/image.h"
#include "plan/capabilities.h"
#include "plan/plan.h"
#include "projection/gl_project_tables.h"
#include "projection/gl_tet_stream.h"
#include "projection/project_renderer.h"
#include "projection/stored_gradients.h"
#include "projection/visible_parts.h"
#include "scene/scene_mesh.h"
#include "visibility/visibility_order.h"

namespace lamina {

// Tells whether the plan needs a program of that kind beside those of later kinds.
bool has_program(const ProjectPlan& plan, FragmentKind kind);
// Returns the definitions that specialise projection/tet.frag and its vertex shader, except for the
// tables.
gl::Defines project_defines(const ProjectPlan& plan, FragmentKind kind);

// Draws a mesh as the plan says, in the current OpenGL context, which must outlive the renderer.
class GlProjectRenderer : public ProjectRenderer {
  public:
    // Builds tables and programs, and order and stream if those of another renderer cannot be used;
    // errors of OpenGL are Errors. The mesh must outlive it.
    GlProjectRenderer(const SceneMesh& mesh, const TransferFunction& transfer_function,
                      const ProjectPlan& plan, const Capabilities& capabilities, int width,
                      int height, std::shared_ptr<VisibilityOrder> order = nullptr,
                      std::shared_ptr<GlTetStream> stream = nullptr);
    GlProjectRenderer(const GlProjectRenderer&) = delete;
    GlProjectRenderer& operator=(const GlProjectRenderer&) = delete;

    bool take(const Plan& plan) override;
    void draw(const View& view, Progress* progress = nullptr) override;
    int step_count() const override;
    using FrameRenderer::read;
    void read(Image& image) const override;
    std::map<std::string, double> stages_ms() const override;
    const OrderReport& order_report() const override { return order_->report(); }
    ProjectParts parts() const override { return {order_, stream_}; }
    std::int64_t tets_drawn() const override { return tets_drawn_; }

    // Times of the last frame:
    double order_ms() const { return order_ms_; }
    double geometry_ms() const { return stream_ ? stream_->write_ms() : 0; }
    double draw_ms() const {
        return draw_ms_;
    }  // includes the geometry, which is written at the same time
    double table_ms() const { return tables_ ? tables_->build_ms() : 0; }
    std::int64_t table_bytes() const { return tables_ ? tables_->table_bytes() : 0; }

  private:
    gl::Program make_program(FragmentKind kind) const;
    void make_stream(std::shared_ptr<GlTetStream> ready);
    void make_tree();
    void set_view(gl::Program& program, const View& view) const;
    void set_light(gl::Program& program, const View& view) const;
    void draw_parts(const DrawOrder<TetPart>& parts, const View& view, Progress* progress);

    const SceneMesh& mesh_;
    TransferFunction transfer_function_;  // in the plan's units
    ProjectPlan plan_;
    double margin_;
    gl::Framebuffer target_;
    TetPieces pieces_;
    std::shared_ptr<VisibilityOrder> order_;
    // None if nothing is visible.
    std::optional<GlProjectTables> tables_;
    StoredGradients gradients_;                                        // empty if nothing is lit
    std::array<std::optional<gl::Program>, fragment_kinds> programs_;  // by FragmentKind
    std::shared_ptr<GlTetStream> stream_;
    std::optional<VisibleParts> parts_;
    std::optional<GlFixedTree> tree_;  // if the plan has one
    std::int64_t tets_drawn_ = 0;
    double order_ms_ = 0, draw_ms_ = 0;
};

}  // namespace lamina
