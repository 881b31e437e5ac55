// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "compositing/tree_shape.h"
#include "plan/plan.h"
#include "projection/tet_projector.h"
#include "projection/visible_cell_fragments.h"
#include "scene/scene.h"
#include "visibility/visibility_order.h"

namespace lamina {

class GlTetStream;

// Objects of a renderer that the next renderer of the same mesh can use again.
struct ProjectReuse {
    std::shared_ptr<VisibilityOrder> order;
    std::shared_ptr<GlTetStream> stream;  // buffers of OpenGL
};

// Draws frames of a mesh by projecting its tets: the base of the CPU's and OpenGL's renderers.
class ProjectRenderer : public FrameRenderer {
  public:
    bool try_switch_to(const Plan& plan) override {
        return plan.project.picture() == plan_.picture();
    }
    virtual ProjectReuse reusable() const = 0;
    // The next three functions describe the last frame.
    bool sorts_tets() const { return order_->method() != OrderMethod::none; }
    const OrderReport& order_report() const { return order_->report(); }
    std::int64_t tets_drawn() const { return tets_drawn_; }  // tets that cover a pixel centre

    // Makes the mesh live as long as the renderer.
    void keep(std::shared_ptr<const SceneMesh> mesh) { kept_mesh_ = std::move(mesh); }
    const SceneMesh* kept_mesh() const { return kept_mesh_.get(); }

  private:
    std::shared_ptr<const SceneMesh> kept_mesh_;

  protected:
    ProjectRenderer(const ProjectRenderer&) = delete;
    ProjectRenderer& operator=(const ProjectRenderer&) = delete;
    // Uses the order `ready` if it is not null and has the plan's method, or else makes one. Finds
    // gradients and cell fragments if the plan needs them.
    ProjectRenderer(const SceneMesh& mesh, const TransferFunction& transfer_function,
                    const ProjectPlan& plan, std::shared_ptr<VisibilityOrder> ready);
    bool is_fan() const { return plan_.geometry == ProjectGeometry::triangles; }
    // Returns the shape of the plan's tree, or nothing if there is none. Its samples are the mesh's
    // cell fragments, whose number does not depend on the view.
    std::optional<TreeShape> tree_shape() const;

    const SceneMesh& mesh_;
    TransferFunction transfer_function_;  // in the plan's units
    ProjectPlan plan_;
    TetPieces pieces_;
    std::shared_ptr<VisibilityOrder> order_;
    StoredGradients gradients_;                    // empty if nothing is lit
    std::optional<VisibleCellFragments> visible_;  // none if nothing is visible or rays walk
    std::int64_t tets_drawn_ = 0;
    double table_ms_ = 0;                // time to build tables
    double order_ms_ = 0, draw_ms_ = 0;  // times in the last frame
};

// Makes a CpuProjectRenderer if capabilities.cpu is true, or else a GlProjectRenderer in the
// current OpenGL context. The mesh and the context must outlive it. `ready`: objects of a renderer
// of the same mesh and capabilities that draws no more; may be empty.
std::unique_ptr<ProjectRenderer> make_project_renderer(const SceneMesh& mesh,
                                                       const TransferFunction& transfer_function,
                                                       const ProjectPlan& plan,
                                                       const Capabilities& capabilities, int width,
                                                       int height, const ProjectReuse& ready = {});

}  // namespace lamina
