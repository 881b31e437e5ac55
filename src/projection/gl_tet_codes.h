// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "executors/gl_code_tree.h"
#include "executors/gl_pixels.h"
#include "gl/pace.h"
#include "gl/program.h"
#include "gl/sync.h"
#include "gl/texture.h"
#include "gl/timeline.h"
#include "projection/gl_project_renderer.h"
#include "projection/project_renderer.h"
#include "projection/tet_projector.h"
#include "projection/tile_lists.h"

namespace lamina {

// Returns the definitions of projection/codes.comp.
gl::Defines tet_code_defines(const ProjectPlan& plan, const GlProjectTables& tables);

// Returns the number of entries of a tile's list for one dispatch of projection/codes.comp.
// `intervals`: GlProjectTables::intervals(). Throws Error if the context's loops are too short for
// one cell fragment.
int most_in_dispatch(const ProjectPlan& plan, int intervals, const Capabilities& capabilities);

// The pixels of a tile: a bit each, row after row from the upper left one on.
using TilePixelBits = std::uint64_t;

// Returns the pixels of the tile of this upper left pixel that lie in the area and within the
// outline, which was found for this area and blocks of one pixel.
TilePixelBits pixels_in_tile(const PixelArea& area, const TetOutline& outline, int column, int row);

// A cell fragment in the list of a tile, as shaders/projection/codes.comp reads it.
struct CodeEntry {
    std::uint32_t upper_pixels, lower_pixels;  // the halves of TilePixelBits
    std::uint32_t record;                      // its number
};
using CodeLists = TileLists<CodeEntry>;

// Draws a mesh on codes, for Target::emulated and ProjectDither::after_blend, in the current OpenGL
// context, which must outlive it. A compute shader composites the cell fragments that are listed
// for each tile of the picture, in visibility order.
class GlTetCodes : public ProjectRenderer {
  public:
    static constexpr std::size_t most_entries = std::size_t{1} << 22;  // of all lists: 48 MiB

    // The plan must have Blending::registers. The mesh must outlive the renderer. `entries`: bound
    // on the entries of all tiles' lists at a time; the context may allow fewer. Throws Error if a
    // cell fragment that fills the picture has more.
    GlTetCodes(const SceneMesh& mesh, const TransferFunction& transfer_function,
               const ProjectPlan& plan, int width, int height,
               std::shared_ptr<VisibilityOrder> order = nullptr,
               std::size_t entries = most_entries);

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
    void project(const TetProjector& projector, const DrawOrder<CellFragment>& batch);
    void upload_records(std::size_t count);
    TetOutline outline_of_record(std::size_t number, FragmentKind kind) const;
    // Lists cell fragments of the batch, from `first` on, for the tiles.
    void list(std::size_t first, std::size_t count);
    void dispatch();

    int width_, height_;
    std::optional<GlProjectTables> tables_;  // none if nothing is visible
    std::optional<gl::Program> program_;
    GlPixels picture_;
    std::optional<GlCodeTree> tree_;    // if the plan has one
    std::optional<gl::WorkPace> pace_;  // of the entries of a tile's list
    std::size_t most_entries_;          // of all lists
    gl::Timeline timeline_;
    double list_ms_ = 0;
    std::array<gl::Fence, 2> drawn_;  // of the last rounds of lists
    std::size_t rounds_ = 0;          // of lists, so far
    // The following belong to a batch.
    std::vector<SilhouetteRecord> records_;
    std::vector<GradientRecord> gradient_records_;
    std::vector<PixelArea> areas_;
    std::vector<TetOutline> outlines_;  // empty on GPUs
    CodeLists lists_;
    gl::TexelBuffer record_texels_, gradient_texels_, entry_texels_;
    gl::Buffer tile_buffer_;
};

}  // namespace lamina
