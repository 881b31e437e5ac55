// SPDX-License-Identifier: Apache-2.0
#include "window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_impl_glfw.h>
#include <imgui_impl_opengl3.h>

#include <algorithm>
#include <utility>

#include "model/input_event.h"
#include "lamina/error.h"
#include "panels/theme.h"
#include "viewer.h"

namespace lamina::view {
namespace {

std::string glfw_message() {
    const char* text = nullptr;
    glfwGetError(&text);
    return text == nullptr ? "no reason given" : text;
}

GLFWwindow* make_window(int width, int height) {
    if (glfwInit() == GLFW_FALSE)
        throw Error(
            fmt::format("no window system: {}, expected an X or Wayland display", glfw_message()));
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
    glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
    GLFWwindow* const window = glfwCreateWindow(width, height, "lamina", nullptr, nullptr);
    if (window != nullptr) return window;
    const std::string reason = glfw_message();
    glfwTerminate();
    throw Error(fmt::format("no window: {}, expected OpenGL 3.3", reason));
}

}  // namespace

Window::Window(const WindowOptions& options) : window_(make_window(options.width, options.height)) {
    glfwMakeContextCurrent(window_);
    glfwSwapInterval(1);
    gladLoadGLContext(&gl_, glfwGetProcAddress);
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;
    float scale = 1;
    glfwGetWindowContentScale(window_, &scale, nullptr);
    set_theme(std::max(scale, 1.f));
    ImGui_ImplGlfw_InitForOpenGL(window_, false);
    ImGui_ImplOpenGL3_Init("#version 330 core");
    viewer_ = std::make_unique<Viewer>(gl_, options.session, [] { glfwPostEmptyEvent(); });
    set_callbacks();
    if (!options.file.empty()) viewer_->open(options.file);
}

Window::~Window() {
    viewer_.reset();
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
    glfwDestroyWindow(window_);
    glfwTerminate();
}

Window& Window::of(GLFWwindow* window) {
    return *static_cast<Window*>(glfwGetWindowUserPointer(window));
}

// ImGui's own handlers come first, so that it can say whether it wants an event for itself.
void Window::set_callbacks() {
    glfwSetWindowUserPointer(window_, this);
    glfwSetWindowFocusCallback(window_, ImGui_ImplGlfw_WindowFocusCallback);
    glfwSetCursorEnterCallback(window_, ImGui_ImplGlfw_CursorEnterCallback);
    glfwSetCharCallback(window_, ImGui_ImplGlfw_CharCallback);
    glfwSetDropCallback(window_, [](GLFWwindow* window, int count, const char** paths) {
        of(window).handle({.kind = InputEvent::Kind::drop, .files = {paths, paths + count}});
    });
}

void Window::handle(const InputEvent& event) {
    viewer_->handle(event);
}

void Window::run() {
    while (glfwWindowShouldClose(window_) == GLFW_FALSE && !viewer_->is_closing()) {
        if (frames_left_ > 0) {
            glfwPollEvents();
            --frames_left_;
        } else {
            glfwWaitEvents();
            frames_left_ = 2;
        }
        frame();
    }
}

void Window::frame() {
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
    const ImGuiIO& io = ImGui::GetIO();
    viewer_->frame(io.DisplaySize.x, io.DisplaySize.y, io.DisplayFramebufferScale.x);
    ImGui::Render();
    int width = 0, height = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    gl_.Viewport(0, 0, width, height);
    gl_.ClearColor(.1f, .1f, .1f, 1);
    gl_.Clear(GL_COLOR_BUFFER_BIT);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
    glfwSwapBuffers(window_);
    if (std::string title = viewer_->title(); title != title_) {
        title_ = std::move(title);
        glfwSetWindowTitle(window_, title_.c_str());
    }
}

}  // namespace lamina::view
