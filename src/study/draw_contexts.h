// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>

#include "render/draw_context.h"

namespace lamina::study {

// Contexts by their words (--context), made when first asked for. Of those with OpenGL only one is
// there at a time, current in the thread that asked for it.
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
    std::unique_ptr<gl::CurrentContext> current_;
};

}  // namespace lamina::study
