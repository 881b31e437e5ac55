// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "base/client.h"
#include "compositing/tree_shape.h"
#include "executors/gl_pixels.h"
#include "gl/program.h"
#include "gl/sync.h"
#include "slicing/gl_row_bands.h"
#include "slicing/gl_slab_source.h"
#include "slicing/slab_geometry.h"

namespace lamina {

// Sets the definitions of shaders/gl/march.glsl.
void set_rays(gl::Defines& defines, const RayDispatch& rays);

// Lists tiles of a picture in the order in which they are drawn: those that took longest in the
// last frame first, so that none begins late and ends alone.
class TilesByCost {
  public:
    TilesByCost(int width, int height, int group);

    void begin_frame();  // looks at the last frame's costs
    // Binds the list of these pixels' tiles, and where their costs are noted.
    void bind(const DrawnPixels& pixels, gl::Program& program);
    void end_frame();  // begins to read the costs

  private:
    static constexpr std::size_t classes = 64;  // of costs; tiles of one stay in their order

    void classify(std::span<const std::uint32_t> costs);
    std::size_t class_of(const glm::ivec2& pixel) const;
    void list(const DrawnPixels& pixels);

    glm::ivec2 tile_, count_;  // size and number of tiles of the whole picture
    gl::Buffer costs_, order_;
    gl::ReadBack reading_;
    bool read_ = false;                       // a frame is done
    std::vector<std::uint8_t> cost_classes_;  // by tile, 0 for the longest
    std::vector<std::uint32_t> listed_;
    std::optional<DrawnPixels> listed_pixels_;  // in this frame
};

// Tells compute shaders that march slabs (leaf.comp, codes.comp) which slabs of which bricks they
// draw, in which pixels.
class GlMarch {
  public:
    // `source` and `plan` must outlive the march.
    GlMarch(const GlSlabSource& source, const SlicePlan& plan);

    // Sets the view of the march and of the program.
    void set_view(const View& view, const Slabs& slabs, Order order, gl::Program& program);

    // Slabs that one dispatch draws, in one brick.
    struct Part {
        std::size_t brick;
        SampleSpan slabs;
    };
    // Returns the dispatches of these slabs, in order. No dispatch has more slabs than the plan
    // allows, and a brick is drawn in the slabs alone that may show some of it. But the last
    // dispatch is always there, because it may have to write what was drawn.
    const std::vector<Part>& parts_of(const SampleSpan& span);
    // Draws a part in the pixels of a band that may show something. Uniforms of
    // GlSlabSource::bind() must be set.
    void draw(const Part& part, const RowBand& band, gl::Program& program);
    DrawnPixels drawn_in(const RowBand& band) const;
    void end_frame();  // must be called behind the frame's last draw

  private:
    // A brick, and the range of slabs in which it may show something.
    struct SeenBrick {
        std::size_t number;
        double first_slab, end_slab;
    };

    const GlSlabSource& source_;
    const SlicePlan& plan_;
    std::optional<View> view_;
    Slabs slabs_;
    Order order_ = Order::front_to_back;
    PixelBox seen_;                         // pixels in which something may show
    std::vector<std::size_t> brick_order_;  // all bricks
    std::vector<SeenBrick> bricks_;         // in this order
    std::vector<Part> parts_;               // of the last span
    std::optional<gl::Buffer> next_tile_;   // of the queue, if there is one
    std::optional<TilesByCost> by_cost_;    // if tiles are sorted
};

// A picture that compute shaders march (GlShaderTree, GlCodeSlabs).
class GlMarchedPicture {
  public:
    virtual ~GlMarchedPicture() = default;

    virtual int step_count() const = 0;  // steps that draw() reports
    // Must be called after source and plan have changed in what belongs to one view alone.
    virtual void take_plan() = 0;
    virtual void set_view(const View& view, const Slabs& slabs) = 0;
    virtual void clear() = 0;
    // Draws the picture, which must be clear. Ctrl-C ends it between dispatches.
    virtual void draw(Progress* progress) = 0;
    virtual void end_frame() = 0;  // waits for what was drawn
    virtual void read(Image& image) const = 0;
};

// Returns the number of dispatches into which parts_of() divides slabs of one brick.
int dispatches_of(const SlicePlan& plan, int slabs);

}  // namespace lamina
