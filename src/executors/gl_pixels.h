// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <vector>

#include "gl/api.h"
#include "gl/program.h"
#include "gl/sync.h"
#include "lamina/image.h"
#include "plan/compositing_plan.h"

namespace lamina {

// How shaders pack the numbers of a pixel into words of 32 bits (compositing/packed_pixel.glsl).
enum class PixelPacking { floats, halves, shorts, bytes };

PixelPacking packing_of(const CompositingPlan& plan);  // for the plan's target
int words_of(PixelPacking packing);                    // words of a pixel with four channels
void set_packing(gl::Defines& defines, const CompositingPlan& plan);

// The pixels that a compute shader draws (gl/pixels.glsl); end_column and end_row are not drawn.
struct DrawnPixels {
    int first_column = 0, first_row = 0, end_column = 0, end_row = 0;

    bool empty() const { return first_column >= end_column || first_row >= end_row; }
    friend bool operator==(const DrawnPixels&, const DrawnPixels&) = default;
};
// Returns the columns and rows of a tile of shaders/gl/tile.glsl, for workgroups of so many.
glm::ivec2 tile_size(int group);
// Tells a compute shader that includes gl/pixels.glsl which pixels it draws, and returns the
// columns and rows of their tiles. `group`: invocations of a workgroup.
glm::ivec2 set_pixels(gl::Program& program, const DrawnPixels& pixels, int group);
// Runs such a shader, with workgroups of 64, for these pixels, unless there are none.
void dispatch_pixels(gl::Program& program, const DrawnPixels& pixels);

// The picture of a compute shader: pixels of packed words in a storage buffer, row 0 at the top.
class GlPixels {
  public:
    GlPixels(PixelPacking packing, int width, int height);

    void clear() { words_.clear(); }  // sets all pixels to 0
    // Binds rows to the storage block that shaders declare with `binding`.
    void bind(unsigned binding, int first_row, int rows) const;
    int row_words() const { return row_words_; }
    // Waits for the draws. `largest`: the largest code of a picture of codes.
    void read(Image& image, double largest) const;

  private:
    void unpack_rows(Image& image, int first, int rows) const;  // which were taken
    void set_values(double largest) const;                      // unless they are set

    PixelPacking packing_;
    int width_, height_, row_words_;
    gl::Buffer words_;
    // read() keeps the following, so that no frame allocates.
    mutable gl::ReadBack reading_;
    mutable std::vector<float> values_;  // the values of all numbers of 8 or 16 bits
    mutable double largest_ = 0;         // the largest code, for which these are
};

}  // namespace lamina
