// SPDX-License-Identifier: Apache-2.0
#include "render/draw_context.h"

#include "base/enum_words.h"
#include "base/error.h"
#include "tiles/tile_capabilities.h"

namespace lamina {
namespace {

// Returns null if there is no GPU with OpenGL 4.5.
std::unique_ptr<gl::Context> find_gpu() {
    try {
        return gl::Context::create(gl::ContextKind::gpu);
    } catch (const Error&) {
        return nullptr;
    }
}

std::unique_ptr<gl::Context> make_opengl(const Auto<ContextChoice>& choice) {
    if (choice.is_automatic()) return find_gpu();
    switch (*choice) {
        case ContextChoice::osmesa:
            return gl::Context::create(gl::ContextKind::osmesa);
        case ContextChoice::egl:
            return gl::Context::create(gl::ContextKind::egl);
        case ContextChoice::cpu:
            return nullptr;
    }
    unreachable_enum();
}

}  // namespace

DrawContext::DrawContext(const Auto<ContextChoice>& choice)
    : opengl_(make_opengl(choice)),
      capabilities_(opengl_ ? opengl_->capabilities() : tile_capabilities()) {}

DrawContext::DrawContext(gl::ContextKind kind)
    : opengl_(gl::Context::create(kind)), capabilities_(opengl_->capabilities()) {}

std::unique_ptr<gl::CurrentContext> DrawContext::make_current() const {
    return opengl_ ? std::make_unique<gl::CurrentContext>(*opengl_) : nullptr;
}

}  // namespace lamina
