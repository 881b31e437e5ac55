// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glad/gl.h>

#include <filesystem>
#include <memory>
#include <string>

#include "lamina/session.h"

struct GLFWwindow;

namespace lamina::view {

struct InputEvent;
class Viewer;

struct WindowOptions {
    std::filesystem::path file;  // to be opened; empty: none
    int width = 1280, height = 860;
    SessionOptions session;
};

// The window with its OpenGL and ImGui. One at a time.
class Window {
  public:
    // Throws Error where there is no display or no OpenGL 3.3.
    explicit Window(const WindowOptions& options);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    void run();  // until it is closed

  private:
    static Window& of(GLFWwindow* window);
    void set_callbacks();
    void frame();
    void handle(const InputEvent& event);

    GLFWwindow* window_ = nullptr;
    GladGLContext gl_{};
    std::unique_ptr<Viewer> viewer_;
    int frames_left_ = 3;  // ImGui needs some until what happened shows
    std::string title_;
};

}  // namespace lamina::view
