// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <glm/vec4.hpp>
#include <initializer_list>
#include <vector>

#include "gl/api.h"
#include "gl/program.h"
#include "gl/texture.h"
#include "lamina/image.h"

namespace lamina::gl {

// Render targets, its own 2D textures of one size. Texture i receives the output `location = i`.
class Framebuffer {
  public:
    // Throws Error if the driver cannot draw into these formats.
    explicit Framebuffer(std::vector<Texture> colors);
    explicit Framebuffer(Texture color);

    void bind() const;  // for drawing; the viewport covers all of it
    void clear(const glm::vec4& rgba, std::size_t target = 0);

    // Reads a target as floats. OpenGL's row 0 is the bottom one, the image's row 0 the top one.
    // Reading into `image` takes no memory if that has the target's size.
    Image read_back(std::size_t target = 0) const;
    void read_back(Image& image, std::size_t target = 0) const;

    const Texture& color(std::size_t target = 0) const { return colors_[target]; }
    int width() const { return colors_.front().width(); }
    int height() const { return colors_.front().height(); }
    unsigned id() const { return handle_.id(); }

  private:
    std::vector<Texture> colors_;
    Handle<ObjectKind::framebuffer> handle_;
};

// Draws into single layers of array textures that belong to others and must outlive it.
class LayerFramebuffer {
  public:
    LayerFramebuffer();

    // Binds a layer of each texture for drawing, texture i for the output i, all of its area.
    void bind(std::initializer_list<const Texture*> arrays, int layer);
    void clear();  // sets all bound targets to zero

  private:
    Handle<ObjectKind::framebuffer> handle_;
    int bound_ = 0;
};

// Runs the program, whose vertex shader is "gl/full_screen.vert", for every pixel of the target.
void draw_full_screen(const Program& program);
// Draws with a given vertex array, so that frames need not make one.
void draw_full_screen(const Program& program, const VertexArray& any);

// The largest errors of a filter against exact trilinear interpolation, as shares of the range.
struct FilterError {
    double found = 0;
    double eight_bit = 0;  // error of weights rounded to 8 bits, at the same places
    // Tells whether weights are rounded to 8 bits or better; truncated ones err twice as much.
    bool as_good_as_eight_bits() const { return found <= 1.1 * eight_bit; }
};

// Measures the context's linear filter of a 3D texture of r8, r16 or r32f. llvmpipe has 1e-7, but
// .18 for r8 with values 7 codes apart: it rounds to codes (docs/numerics.md, section 2).
FilterError measure_filter_error(TextureFormat format);

}  // namespace lamina::gl
