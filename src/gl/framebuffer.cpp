// SPDX-License-Identifier: Apache-2.0
#include "gl/framebuffer.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include <glad/gl.h>
#include "base/error.h"
#include "gl/api.h"

namespace lamina::gl {

namespace {

unsigned new_framebuffer() {
    GLuint id = 0;
    api().CreateFramebuffers(1, &id);
    return id;
}

std::vector<Texture> as_list(Texture color) {
    std::vector<Texture> colors;
    colors.push_back(std::move(color));
    return colors;
}

}  // namespace

Framebuffer::Framebuffer(Texture color) : Framebuffer(as_list(std::move(color))) {}

Framebuffer::Framebuffer(std::vector<Texture> colors)
    : colors_(std::move(colors)), handle_(new_framebuffer()) {
    assert(!colors_.empty());
    std::vector<GLenum> outputs;
    for (const Texture& color : colors_) {
        assert(color.width() == width() && color.height() == height() && color.depth() == 1);
        outputs.push_back(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(outputs.size()));
        api().NamedFramebufferTexture(id(), outputs.back(), color.id(), 0);
    }
    api().NamedFramebufferDrawBuffers(id(), static_cast<GLsizei>(outputs.size()), outputs.data());
    const GLenum status = api().CheckNamedFramebufferStatus(id(), GL_DRAW_FRAMEBUFFER);
    if (status != GL_FRAMEBUFFER_COMPLETE) {
        fail("OpenGL cannot draw into {} {} textures of {} x {} (framebuffer status {:#x})",
             colors_.size(), info_of(color().format()).name, width(), height(), status);
    }
    check("making a framebuffer");
}

void Framebuffer::bind() const {
    api().BindFramebuffer(GL_FRAMEBUFFER, id());
    api().Viewport(0, 0, width(), height());
}

void Framebuffer::clear(const glm::vec4& rgba, std::size_t target) {
    api().ClearNamedFramebufferfv(id(), GL_COLOR, static_cast<GLint>(target), &rgba.x);
}

Image Framebuffer::read_back(std::size_t target) const {
    Image image;
    read_back(image, target);
    return image;
}

void Framebuffer::read_back(Image& image, std::size_t target) const {
    image.resize(width(), height());
    color(target).read_rgba(image.rgba);
    const std::size_t row = 4 * static_cast<std::size_t>(width());
    for (int top = 0; top < height() / 2; ++top) {
        float* const upper = image.pixel(0, top);
        std::swap_ranges(upper, upper + row, image.pixel(0, height() - 1 - top));
    }
}

LayerFramebuffer::LayerFramebuffer() : handle_(new_framebuffer()) {}

void LayerFramebuffer::bind(std::initializer_list<const Texture*> arrays, int layer) {
    const int count = static_cast<int>(arrays.size());
    std::vector<GLenum> outputs;
    for (const Texture* const array : arrays) {
        outputs.push_back(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(outputs.size()));
        api().NamedFramebufferTextureLayer(handle_.id(), outputs.back(), array->id(), 0, layer);
    }
    if (count != bound_) {
        api().NamedFramebufferDrawBuffers(handle_.id(), count, outputs.data());
        bound_ = count;
    }
    api().BindFramebuffer(GL_FRAMEBUFFER, handle_.id());
    api().Viewport(0, 0, (*arrays.begin())->width(), (*arrays.begin())->height());
}

void LayerFramebuffer::clear() {
    const float zero[4] = {0, 0, 0, 0};
    for (int target = 0; target < bound_; ++target) {
        api().ClearNamedFramebufferfv(handle_.id(), GL_COLOR, target, zero);
    }
}

void draw_full_screen(const Program& program) {
    draw_full_screen(program, VertexArray());
}

void draw_full_screen(const Program& program, const VertexArray& any) {
    any.bind();
    program.use();
    api().DrawArrays(GL_TRIANGLES, 0, 3);
    check("drawing over the whole target");
}

}  // namespace lamina::gl
