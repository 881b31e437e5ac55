// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <glm/vec4.hpp>
#include <vector>

#include "gl/api.h"
#include "gl/program.h"
#include "gl/sync.h"
#include "gl/texture.h"
#include "lamina/image.h"

namespace lamina::gl {

// Owns 2D textures of one size as render targets. Texture i receives the output `location = i`.
class Framebuffer {
  public:
    // Throws Error if the driver cannot draw into these formats.
    explicit Framebuffer(std::vector<Texture> colors);
    explicit Framebuffer(Texture color);

    void bind() const;  // for drawing; the viewport covers the targets
    void clear(const glm::vec4& rgba, std::size_t target = 0);

    // Reads a target as floats. OpenGL's row 0 is the bottom one, the image's row 0 the top one.
    // Reading into `image` does not allocate if `image` has the target's size.
    Image read_back(std::size_t target = 0) const;
    void read_back(Image& image, std::size_t target = 0) const;

    const Texture& color(std::size_t target = 0) const { return colors_[target]; }
    int width() const { return colors_.front().width(); }
    int height() const { return colors_.front().height(); }
    unsigned id() const { return handle_.id(); }

  private:
    std::vector<Texture> colors_;
    Handle<ObjectKind::framebuffer> handle_;
    mutable ReadBack reading_;
};

// Runs the program (vertex shader "gl/full_screen.vert") for all pixels of the bound target.
void draw_full_screen(const Program& program);
// Draws with the caller's vertex array, even an empty one, so that no frame makes one.
void draw_full_screen(const Program& program, const VertexArray& any);

// Largest errors of a linear filter against exact interpolation, as shares of the value range.
struct FilterError {
    double found = 0;
    double eight_bit = 0;  // the error that weights rounded to 8 bits make at the same positions
    // Tells whether weights are rounded to 8 bits or better; truncated weights err twice as much.
    bool as_good_as_eight_bits() const { return found <= 1.1 * eight_bit; }
};

// Measures the context's linear filter on a 3D texture of r8, r16 or r32f. On llvmpipe the error is
// 1e-7, but .18 for r8 (7 codes): results are whole codes (docs/numerics.md, section 2).
FilterError measure_filter_error(TextureFormat format);

}  // namespace lamina::gl
