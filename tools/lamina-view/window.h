// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glad/gl.h>

#include <array>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <glm/vec2.hpp>
#include <memory>
#include <optional>
#include <string>

#include "lamina/session.h"
#include "model/navigator.h"

struct GLFWwindow;

namespace lamina::view {

class ScriptPlayer;
class Viewer;

struct WindowOptions {
    std::filesystem::path file;    // file to open; empty: none
    std::filesystem::path script;  // script to play; empty: none
    std::optional<glm::ivec2> picture_size;
    SessionOptions session;
};

// The window with its OpenGL context and ImGui. Only one may exist at a time.
class Window {
  public:
    // Throws Error if there is no display or no OpenGL 3.3.
    explicit Window(const WindowOptions& options);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    // Shows frames until the window is closed or the script ends. Throws Error if a command of the
    // script fails.
    void run();

    // Input of the user or of a script. Places are in the window, from its upper left corner.
    void move(const glm::dvec2& place);
    void button(PointerButton button, bool down, bool shift, bool control);
    void wheel(const glm::dvec2& steps);
    void key(int key, bool down, bool shift, bool control);
    void character(unsigned unicode);
    void set_size(int width, int height);
    void close();
    void take_screenshot(const std::filesystem::path& file);  // of the next frame

  private:
    static Window& of(GLFWwindow* window);
    void set_callbacks();
    void wait_for_events();
    std::optional<double> next_frame(double now) const;
    void frame();
    void give_input_to_imgui();
    void measure(double began);
    void write_screenshot(int width, int height);

    GLFWwindow* window_ = nullptr;
    GladGLContext gl_{};
    std::unique_ptr<Viewer> viewer_;
    std::unique_ptr<ScriptPlayer> player_;  // null without a script
    int frames_left_ = 3;            // frames to draw: ImGui shows some effects of input late
    bool touched_ = false;           // something happened to the window
    std::atomic<bool> news_{false};  // the viewer has something new to show
    std::string title_;
    std::filesystem::path screenshot_;
    glm::dvec2 pointer_{-1};
    // For each button: it is down; it was down at some time since the last frame.
    std::array<bool, 3> down_{}, went_down_{};
    std::chrono::steady_clock::time_point measured_ = {};  // input time of the last latency
};

}  // namespace lamina::view
