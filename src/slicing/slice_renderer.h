// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <optional>

#include "base/client.h"
#include "executors/fixed_tree.h"
#include "lamina/image.h"
#include "lamina/volume.h"
#include "plan/plan.h"
#include "slicing/cpu_slabs.h"

namespace lamina {

class CpuVolume;
class GlVolume;

// The volume as a renderer has prepared it. The next renderer uses it if it has the form needed.
struct SliceReuse {
    std::shared_ptr<const CpuVolume> tiles;    // of the engine `cpu`
    std::shared_ptr<const GlVolume> textures;  // of OpenGL
};

// A renderer of volumes whose prepared volume other renderers can use.
class SliceRenderer : public FrameRenderer {
  public:
    virtual SliceReuse reusable() const = 0;
};

// Makes a renderer that draws a volume as the plan says. The capabilities decide whether it is the
// engine `cpu` or OpenGL in the current context. The context and the volume must outlive the
// renderer. `ready`: reusable() of a renderer of the same volume and capabilities, or empty.
std::unique_ptr<SliceRenderer> make_slice_renderer(const Volume& volume,
                                                   const TransferFunction& transfer_function,
                                                   const Facts& facts, const SlicePlan& plan,
                                                   const Capabilities& capabilities, int width,
                                                   int height, const SliceReuse& ready = {});

// Draws a volume as the plan says, on the CPU (slice_renderer.cpp has the algorithm).
// GlSliceRenderer draws it with OpenGL.
class CpuSliceRenderer : public SliceRenderer {
  public:
    // Prepares volume and tables. `ready`: another renderer's volume(), used if of the right form.
    CpuSliceRenderer(const Volume& volume, const TransferFunction& transfer_function,
                     const Facts& facts, const SlicePlan& plan, int width, int height,
                     std::shared_ptr<const CpuVolume> ready = nullptr);
    CpuSliceRenderer(const CpuSliceRenderer&) = delete;  // its members refer to each other
    CpuSliceRenderer& operator=(const CpuSliceRenderer&) = delete;

    bool try_switch_to(const Plan& plan) override;
    // Draws a frame; its steps are tiles. After the first frame it allocates no memory. Throws
    // Error if the files of a volume that stays on disk have changed.
    void draw(const View& view, Progress* progress = nullptr) override;
    int step_count() const override { return prepared_ ? target_.grid().count() : 0; }
    using FrameRenderer::read;
    void read(Image& image) const override;
    std::map<std::string, double> stages_ms() const override;
    std::int64_t fragments() const override { return samples_; }  // segments of rays

    SliceReuse reusable() const override { return {volume_, nullptr}; }
    const std::shared_ptr<const CpuVolume>& volume() const { return volume_; }
    std::int64_t byte_count() const override;  // host memory that it takes, without the volume

  private:
    // Prepares what slabs are computed from: the volume, and the transfer function in the plan's
    // units with its tables. Views are in the plan's units, too, facts in world units.
    void prepare(const Volume& volume, const TransferFunction& transfer_function,
                 const Facts& facts);
    // Sets what slabs_ says about empty and constant bricks, which may change from view to view.
    void set_cells();
    void set_view(const View& view, const Slabs& slabs);
    void set_rays(const View& view, const Slabs& slabs);
    void add_brick(std::size_t number, const View& view, const Slabs& slabs);
    // Adds to seen_ the pixels in which a brick may show something.
    void add_visible_pixels(const CpuBrickView& brick, const View& view);
    bool keep_to_share(const IndexBox& share, CpuBrickView& brick) const;
    void load_pages(const View& view) const;
    void clear_tile(int number);
    std::int64_t draw_tile(int number);

    SlicePlan plan_;
    Grid grid_;
    TileImage target_;
    std::vector<char> blank_;  // for each tile 1 if it is known to be clear
    TargetBlend blend_;
    bool prepared_ = false;                    // false if nothing was visible in the first plan
    std::shared_ptr<const CpuVolume> volume_;  // kept for another renderer if not needed
    OccupiedBricks occupied_;
    ConstantBricks constant_;
    CellMap cells_;
    bool cells_leave_out_empty_ = false;  // whether cells_ knows empty bricks
    std::optional<CpuTransfer> transfer_;
    std::vector<std::uint32_t> shown_pages_;  // pages with visible cells, if the volume has pages
    std::optional<CpuLight> light_;
    CpuSlabs slabs_;
    PixelBox seen_;                   // pixels in which the view may show something
    std::vector<std::size_t> order_;  // visibility order of bricks
    std::optional<TreeShape> shape_;
    std::optional<CpuFixedTree> fixed_tree_;
    std::atomic<std::int64_t> samples_{0};
    double upload_ms_ = 0, table_ms_ = 0;
    double geometry_ms_ = 0, draw_ms_ = 0;  // of the last frame
};

}  // namespace lamina
