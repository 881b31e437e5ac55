// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "gl/context.h"
#include "plan/capabilities.h"
#include "render/context_choice.h"

namespace lamina {

// The context that draws pictures: one of OpenGL, or the engine `cpu`, for which no OpenGL library
// is loaded.
class DrawContext {
  public:
    // Throws Error if OpenGL fails; an automatic choice then takes the engine `cpu`.
    explicit DrawContext(const Auto<ContextChoice>& choice);
    // Always makes an OpenGL context; throws Error if that fails.
    explicit DrawContext(gl::ContextKind kind);

    const Capabilities& capabilities() const { return capabilities_; }

    // Makes the OpenGL context current in the calling thread while the result lives, and afterwards
    // the caller's own again (gl/context.h). Null for the engine `cpu`, which needs none.
    std::unique_ptr<gl::CurrentContext> make_current() const;

  private:
    std::unique_ptr<gl::Context> opengl_;  // none: the engine `cpu`
    Capabilities capabilities_;
};

}  // namespace lamina
