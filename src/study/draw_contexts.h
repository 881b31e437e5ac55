// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <string>

#include "render/draw_context.h"

namespace lamina::study {

// Contexts by their names (--context), made when they are first needed. Only one OpenGL context
// exists at a time (gl/context.h).
class DrawContexts {
  public:
    // `before_switch`: called before an OpenGL context is destroyed; it must destroy its renderers.
    explicit DrawContexts(std::function<void()> before_switch)
        : before_switch_(std::move(before_switch)) {}
    ~DrawContexts() { before_switch_(); }
    DrawContexts(const DrawContexts&) = delete;
    DrawContexts& operator=(const DrawContexts&) = delete;

    // Throws Error where there is no such context.
    const Capabilities& use(const std::string& word);

  private:
    std::function<void()> before_switch_;
    std::map<std::string, DrawContext> contexts_;
};

}  // namespace lamina::study
