// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/progress.h"
#include "gl/framebuffer.h"
#include "gl/program.h"
#include "image/image.h"
#include "mesh/visibility_order.h"
#include "projection/gl_project_tables.h"
#include "projection/gl_tet_stream.h"
#include "scene/capabilities.h"
#include "scene/plan.h"
#include "scene/scene_mesh.h"

namespace lamina {

// How the fragments of silhouettes find the faces: in float32, or in double.
enum class TetPrecision { plain, careful };
// What projection/tet.frag and its vertex shader are specialised by, but for the tables.
gl::Defines project_defines(const ProjectPlan& plan, TetPrecision precision);

// Draws a mesh as the plan says, in the current OpenGL context, which must outlive it.
class GlProjectRenderer {
  public:
    // Builds order, tables and programs; errors of OpenGL are Errors. The mesh must outlive it.
    GlProjectRenderer(const SceneMesh& mesh, const TransferFunction& transfer_function,
                      const ProjectPlan& plan, const Capabilities& capabilities, int width,
                      int height);
    GlProjectRenderer(const GlProjectRenderer&) = delete;
    GlProjectRenderer& operator=(const GlProjectRenderer&) = delete;

    // Complete when it returns. Ctrl-C ends it between batches; `progress` advances by step_count()
    // in all.
    void draw(const View& view, Progress* progress = nullptr);
    int step_count() const;
    Image read() const;

    const OrderReport& order_report() const { return order_.report(); }
    std::int64_t tets_drawn() const { return tets_drawn_; }  // of the last frame, like these:
    double order_ms() const { return order_ms_; }
    double geometry_ms() const { return stream_ ? stream_->write_ms() : 0; }
    double draw_ms() const { return draw_ms_; }  // with the geometry, which runs beside it
    double table_ms() const { return tables_ ? tables_->build_ms() : 0; }
    std::int64_t table_bytes() const { return tables_ ? tables_->table_bytes() : 0; }

  private:
    std::span<const std::int32_t> visible_tets(const View& view);
    gl::Program make_program(TetPrecision precision) const;
    void set_view(gl::Program& program, const View& view) const;
    void draw_tets(std::span<const std::int32_t> tets, const View& view, Progress* progress);

    const SceneMesh& mesh_;
    const TransferFunction& transfer_function_;
    ProjectPlan plan_;
    double margin_;
    gl::Framebuffer target_;
    VisibilityOrder order_;
    // None where nothing is visible.
    std::optional<GlProjectTables> tables_;
    std::optional<gl::Program> program_;          // plain; none where all tets are careful
    std::optional<gl::Program> careful_program_;  // of silhouettes
    std::optional<GlTetStream> stream_;
    std::vector<char> hidden_;           // tets that show nothing; empty where all are drawn
    std::vector<std::int32_t> visible_;  // of the frame, where some are hidden
    std::int64_t tets_drawn_ = 0;
    double order_ms_ = 0, draw_ms_ = 0;
};

}  // namespace lamina
