// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/progress.h"
#include "lamina/image.h"
#include "plan/plan.h"
#include "projection/fan_geometry.h"
#include "projection/project_renderer.h"
#include "projection/stored_gradients.h"
#include "projection/tet_projector.h"
#include "projection/tet_setup.h"
#include "projection/tile_batch.h"
#include "projection/tile_fragments.h"
#include "projection/tile_project_tables.h"
#include "projection/tile_tet_tree.h"
#include "projection/visible_parts.h"
#include "scene/scene_mesh.h"
#include "tiles/tile_image.h"
#include "visibility/visibility_order.h"

namespace lamina {

// Draws a mesh as the plan says, on the CPU. Cell fragments are projected in batches, in visibility
// order, while the tiles of the picture draw the batch before. The picture does not depend on the
// number of threads.
class TileProjectRenderer : public ProjectRenderer {
  public:
    // Builds tables, and the order if that of another renderer cannot be used. The mesh must
    // outlive it.
    TileProjectRenderer(const SceneMesh& mesh, const TransferFunction& transfer_function,
                        const ProjectPlan& plan, int width, int height,
                        std::shared_ptr<VisibilityOrder> order = nullptr);
    TileProjectRenderer(const TileProjectRenderer&) = delete;
    TileProjectRenderer& operator=(const TileProjectRenderer&) = delete;

    // The steps of the progress are batches.
    bool take(const Plan& plan) override;
    void draw(const View& view, Progress* progress = nullptr) override;
    int step_count() const override;
    using FrameRenderer::read;
    void read(Image& image) const override;
    std::map<std::string, double> stages_ms() const override;

    const OrderReport& order_report() const override { return order_->report(); }
    ProjectParts parts() const override { return {order_, nullptr}; }
    std::int64_t tets_drawn() const override {
        return tets_drawn_;
    }  // of the last frame, like the following
    std::int64_t fragments() const override;
    double order_ms() const { return order_ms_; }
    double draw_ms() const { return draw_ms_; }
    double table_ms() const { return tables_ ? tables_->build_ms() : 0; }
    // Returns the host memory that the renderer takes, without order and tables.
    std::int64_t byte_count() const override;

  private:
    // The projectors of cell fragments in one view.
    struct Projectors {
        TetSetup setup;
        TetProjector careful;
        FanGeometry fans;
    };

    bool is_fan() const { return plan_.geometry == ProjectGeometry::triangles; }
    std::size_t parts_a_chunk() const;
    std::size_t parts_a_batch() const { return batches_[0]->chunk_count() * parts_a_chunk(); }
    std::size_t batch_count(std::size_t parts) const;
    void set_light();
    void set_view(const View& view);
    void clear();
    void draw_parts(const Projectors& projectors, const DrawOrder<TetPart>& parts,
                    TileTetTree::Node* leaf, Progress* progress);
    void draw_tree(const Projectors& projectors, const DrawOrder<TetPart>& parts,
                   Progress* progress);
    void project(const Projectors& projectors, const DrawOrder<TetPart>& parts,
                 TileBatch& batch) const;
    void project_chunk(const Projectors& projectors, const DrawOrder<TetPart>& parts,
                       TileBatch::Chunk& chunk) const;
    // `limit`: the pixels in which the cell fragment is drawn; null for all.
    void project_doubtful(const TetProjector& projector, const TetPart& part,
                          const PixelArea* limit, TileBatch::Chunk& chunk) const;
    void project_fan(const FanGeometry& fans, const TetPart& part, const PixelArea* limit,
                     TileBatch::Chunk& chunk) const;
    void add(const PartArea& area, std::int32_t tet, const PixelArea* limit,
             TileBatch::Chunk& chunk) const;
    void count_tets(const TileBatch& batch);
    void draw(const TileBatch& batch, TileTetTree::Node* leaf);
    void draw_tile(const TileBatch& batch, std::size_t tile, TileTetTree::Node* leaf);

    const SceneMesh& mesh_;
    TransferFunction transfer_function_;  // in the plan's units
    ProjectPlan plan_;
    TetPieces pieces_;
    std::shared_ptr<VisibilityOrder> order_;
    std::optional<TileProjectTables> tables_;  // none if nothing is visible, like these:
    std::optional<VisibleParts> parts_;
    std::optional<TileTetTree> tree_;  // if the plan has one
    StoredGradients gradients_;        // empty if nothing is lit, like this one:
    std::optional<TileLight> light_;
    TetFragments fragments_{};
    TileImage image_;
    std::vector<TilePixels::Plane> slants_;  // for each tile; empty if all are 1
    double slant_pixel_ = 0;                 // View::pixel that the slants were computed for
    // One is projected while the other is drawn.
    std::array<std::unique_ptr<TileBatch>, 2> batches_;
    std::vector<std::int64_t> fragment_counts_;  // for each tile
    std::int64_t tets_drawn_ = 0;
    std::int32_t last_tet_ = -1;
    double order_ms_ = 0, draw_ms_ = 0;
};

}  // namespace lamina
