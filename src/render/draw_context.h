// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "gl/context.h"
#include "plan/capabilities.h"
#include "render/context_choice.h"

namespace lamina {

// What draws pictures: an OpenGL context, or the native engine, for which no OpenGL library is
// loaded.
class DrawContext {
  public:
    // Throws Error if OpenGL fails; an automatic choice then takes the native engine.
    explicit DrawContext(const Auto<ContextChoice>& choice);
    // Always makes an OpenGL context; throws Error where it fails.
    explicit DrawContext(gl::ContextKind kind);

    const Capabilities& capabilities() const { return capabilities_; }

    // What draws with these capabilities does so while this lives, in the thread that asked for it:
    // the OpenGL context is current, and the caller's own is so again afterwards
    // (gl/context.h). Null for the native engine, which needs none.
    std::unique_ptr<gl::CurrentContext> make_current() const;

  private:
    std::unique_ptr<gl::Context> opengl_;  // none: the native engine
    Capabilities capabilities_;
};

}  // namespace lamina
