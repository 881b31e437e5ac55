// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "compositing/tree_shape.h"
#include "executors/gl_pixels.h"
#include "gl/program.h"
#include "slicing/gl_slab_source.h"
#include "slicing/row_pace.h"
#include "slicing/slab_geometry.h"

namespace lamina {

// Rows of a picture, row 0 at the top.
struct RowBand {
    int first_row = 0, rows = 0;
};

// Returns the largest number of rows, at most `height`, that take at most `most` times as many
// bytes as a row, and which are of whole tiles of gl/pixels.glsl if they hold one. `bands`: into
// how many bands the picture is to be divided at least.
int rows_of_band(int height, int bands, std::int64_t most);

// Draws a picture, band after band, by `draw(band)`. Ctrl-C ends it between bands.
void draw_bands(int height, RowPace& pace, const std::function<void(const RowBand&)>& draw);

// Tells compute shaders that march slabs (leaf.comp, codes.comp) which slabs of which bricks they
// draw, in which pixels.
class GlMarch {
  public:
    // `source` and `plan` must outlive the march.
    GlMarch(const GlSlabSource& source, const SlicePlan& plan) : source_(source), plan_(plan) {}

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
    void draw(const Part& part, const RowBand& band, gl::Program& program) const;
    DrawnPixels drawn_in(const RowBand& band) const;

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
};

// Returns the number of dispatches into which parts_of() divides slabs of one brick.
int dispatches_of(const SlicePlan& plan, int slabs);

}  // namespace lamina
