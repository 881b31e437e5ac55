// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "gl/context.h"
#include "gl/current_context.h"
#include "plan/capabilities.h"
#include "render/context_choice.h"

namespace lamina {

// What draws: OpenGL, or the native engine, for which no library of OpenGL's is loaded.
class DrawContext {
  public:
    // Errors of OpenGL are Errors, but for ContextChoice::automatic.
    explicit DrawContext(ContextChoice choice);
    // OpenGL, whatever it takes.
    explicit DrawContext(gl::ContextKind kind);

    const Capabilities& capabilities() const { return capabilities_; }

    // What draws with these capabilities does so while this lives, in the thread that asked for it:
    // the OpenGL context is current, and the caller's own is so again afterwards
    // (gl/current_context.h). Null for the native engine, which needs none.
    std::unique_ptr<gl::CurrentContext> make_current() const;

  private:
    std::unique_ptr<gl::Context> opengl_;  // none: the native engine
    Capabilities capabilities_;
};

}  // namespace lamina
