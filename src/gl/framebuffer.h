// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <initializer_list>
#include <vector>

#include <glm/vec4.hpp>
#include "gl/api.h"
#include "gl/buffer.h"
#include "gl/program.h"
#include "gl/texture.h"
#include "lamina/image.h"

namespace lamina::gl {

// Render targets: 2D textures of one size, which the framebuffer owns. Texture i receives the
// shader's output `location = i`.
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

    // Binds layer `layer` of each texture for drawing. Texture i receives the shader's output i,
    // and the viewport covers all of it.
    void bind(std::initializer_list<const Texture*> arrays, int layer);
    void clear();  // sets all bound targets to zero

  private:
    Handle<ObjectKind::framebuffer> handle_;
    int bound_ = 0;
};

// Runs the program, whose vertex shader is "gl/full_screen.vert", once for every pixel of the bound
// framebuffer.
void draw_full_screen(const Program& program);
// Draws with a given vertex array, so that frames need not make one.
void draw_full_screen(const Program& program, const VertexArray& any);

}  // namespace lamina::gl
