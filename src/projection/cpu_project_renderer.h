// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "executors/fixed_tree.h"
#include "executors/transfer_tables.h"
#include "projection/cpu_fragments.h"
#include "projection/project_renderer.h"
#include "projection/tet_setup.h"
#include "tiles/tile_image.h"

namespace lamina {

// A compositing tree of fixed-point nodes, evaluated for all tiles together. It keeps one node, an
// opacity plane for each tile, for each level of the tree.
class CpuTetTree {
  public:
    // The opacity of one node, and the tiles with opacity above 0.
    struct Node {
        std::vector<TilePlane> opacity;
        std::vector<std::uint8_t> touched;
    };
    // Composites a leaf's samples, in all tiles, onto a node whose opacity is 0.
    using DrawLeaf = std::function<void(const SampleSpan&, double depth_scale, Node&)>;

    // `plan`: how the nodes are composited. Leaves may be drawn in another format.
    CpuTetTree(const CompositingPlan& plan, const TreeShape& shape,
               const std::array<float, 3>& single_color, const TileGrid& grid);

    int step_count() const { return static_cast<int>(shape_.leaf_count()); }
    // Draws the leaves and composites them into `image`. Ctrl-C ends it between leaves.
    void draw(const DrawLeaf& draw_leaf, TileImage& image, Progress* progress);
    std::int64_t byte_count() const;

  private:
    void evaluate(int level, const SampleSpan& span, const DrawLeaf& draw_leaf, Progress* progress);
    void put_into_parent(int level, const SampleSpan& child, const SampleSpan& parent);

    TreeShape shape_;
    CpuFixedTree tree_;
    TileGrid grid_;
    std::vector<Node> nodes_;  // one for each level, the root first
    // Number of nodes that were put into their parents in this frame; it seeds stochastic rounding.
    std::uint32_t inserted_nodes_ = 0;
};

// Draws a mesh on the CPU. Cell fragments are projected in batches, in visibility order, while the
// tiles draw the previous one. The picture does not depend on the number of threads.
class CpuProjectRenderer : public ProjectRenderer {
  public:
    // Builds tables, and an order unless `order` has the plan's method. The mesh must outlive it.
    CpuProjectRenderer(const SceneMesh& mesh, const TransferFunction& transfer_function,
                       const ProjectPlan& plan, int width, int height,
                       std::shared_ptr<VisibilityOrder> order = nullptr);

    // The steps of the progress are batches.
    void draw(const View& view, Progress* progress = nullptr) override;
    int step_count() const override;
    using FrameRenderer::read;
    void read(Image& image) const override;
    std::map<std::string, double> stages_ms() const override;
    ProjectReuse reusable() const override { return {order_, nullptr}; }
    std::int64_t fragments() const override;
    // Returns the host memory that the renderer takes, without order and tables.
    std::int64_t byte_count() const override;

  private:
    // The projectors of cell fragments in one view.
    struct Projectors {
        TetsInView tets;
        TetProjector careful;
        FanGeometry fans;
    };

    std::size_t chunk_size() const;
    std::size_t batch_size() const { return batches_[0]->chunk_count() * chunk_size(); }
    std::size_t batch_count(std::size_t cell_fragments) const;
    void set_tables();
    void set_view(const View& view);
    void compute_slants(const View& view);
    void draw_cell_fragments(const Projectors& projectors,
                             const DrawOrder<CellFragment>& cell_fragments, CpuTetTree::Node* leaf,
                             Progress* progress);
    void draw_tree(const Projectors& projectors, const DrawOrder<CellFragment>& cell_fragments,
                   Progress* progress);
    void project(const Projectors& projectors, const DrawOrder<CellFragment>& cell_fragments,
                 TileBatch& batch) const;
    void project_chunk(const Projectors& projectors, const DrawOrder<CellFragment>& cell_fragments,
                       TileBatch::Chunk& chunk) const;
    // `limit`: the pixels in which the cell fragment is drawn; null for all.
    void project_careful(const TetProjector& projector, const CellFragment& cell_fragment,
                         const PixelArea* limit, TileBatch::Chunk& chunk) const;
    void project_fan(const FanGeometry& fans, const CellFragment& cell_fragment,
                     const PixelArea* limit, TileBatch::Chunk& chunk) const;
    // `limit`: as for project_careful().
    void add(CoveredArea area, std::int32_t tet, const PixelArea* limit,
             TileBatch::Chunk& chunk) const;
    void draw_batch(const TileBatch& batch, CpuTetTree::Node* leaf);

    // The transfer function in the form that fragments read; fragments_ points to these members.
    std::shared_ptr<const UniformTable> table_;
    std::optional<CpuTransfer> transfer_;  // for SegmentSource::cut_table and ::analytic
    std::optional<CpuTetTree> tree_;       // none if the plan has none
    std::optional<CpuLight> light_;        // none if nothing is lit
    TetFragments fragments_{};
    TileImage image_;
    // For each tile: world length along each pixel's ray per unit of z. Empty if all are 1.
    std::vector<TilePixels::Plane> slants_;
    double slant_pixel_ = 0;  // View::pixel that the slants were computed for
    // Two batches: one is projected while the other is drawn.
    std::array<std::unique_ptr<TileBatch>, 2> batches_;
    std::vector<std::int64_t> fragment_counts_;  // fragments drawn in each tile
    std::int32_t last_tet_ = -1;                 // last tet drawn in this frame
};

}  // namespace lamina
