// SPDX-License-Identifier: Apache-2.0
#include "window.h"

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_impl_glfw.h>
#include <imgui_impl_opengl3.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "lamina/error.h"
#include "lamina/image.h"
#include "panels/theme.h"
#include "script_player.h"
#include "viewer.h"

namespace lamina::view {
namespace {

constexpr int first_width = 1280, first_height = 860;
// Seconds after which news_ is tested again while another thread works: GLFW 3.3 on X11 loses some
// of the events by which the thread wakes it.
constexpr double busy_pause = .02;

std::string glfw_message() {
    const char* text = nullptr;
    glfwGetError(&text);
    std::string message = text == nullptr ? "no reason given" : text;
    message.erase(message.find_last_not_of(" \n") + 1);
    return message;
}

GLFWwindow* make_window() {
    if (glfwInit() == GLFW_FALSE)
        throw Error(fmt::format("no display: {}; DISPLAY has to name an X server", glfw_message()));
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
    glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
    GLFWwindow* const window =
        glfwCreateWindow(first_width, first_height, "lamina", nullptr, nullptr);
    if (window != nullptr) return window;
    const std::string reason = glfw_message();
    glfwTerminate();
    throw Error(fmt::format("no window: {}, expected OpenGL 3.3", reason));
}

PointerButton button_of(int glfw_button) {
    if (glfw_button == GLFW_MOUSE_BUTTON_RIGHT) return PointerButton::right;
    return glfw_button == GLFW_MOUSE_BUTTON_MIDDLE ? PointerButton::middle : PointerButton::left;
}

}  // namespace

Window::Window(const WindowOptions& options) : window_(make_window()) {
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
    // If a script plays, no settings are read: a script does the same for every user.
    viewer_ = std::make_unique<Viewer>(
        gl_, options.session,
        [this] {
            news_ = true;
            glfwPostEmptyEvent();
        },
        options.script.empty() ? ViewerSettings::file() : std::filesystem::path());
    set_callbacks();
    if (!options.script.empty())
        player_ = std::make_unique<ScriptPlayer>(load_script(options.script), *this, *viewer_);
    if (!options.file.empty()) viewer_->open(options.file);
    if (options.picture_size) viewer_->fix_size(options.picture_size->x, options.picture_size->y);
}

Window::~Window() {
    player_.reset();
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

// While a script plays, the user's own pointer and keys are ignored.
void Window::set_callbacks() {
    glfwSetWindowUserPointer(window_, this);
    glfwSetCursorPosCallback(window_, [](GLFWwindow* window, double x, double y) {
        if (!of(window).player_) of(window).move({x, y});
    });
    glfwSetCursorEnterCallback(window_, [](GLFWwindow* window, int entered) {
        Window& self = of(window);
        const bool dragging = std::ranges::find(self.down_, true) != self.down_.end();
        if (!self.player_ && entered == GLFW_FALSE && !dragging) self.move(glm::dvec2(-1));
    });
    glfwSetMouseButtonCallback(window_, [](GLFWwindow* window, int button, int action, int mods) {
        if (!of(window).player_ && button <= GLFW_MOUSE_BUTTON_MIDDLE)
            of(window).button(button_of(button), action == GLFW_PRESS, mods & GLFW_MOD_SHIFT,
                              mods & GLFW_MOD_CONTROL);
    });
    glfwSetScrollCallback(window_, [](GLFWwindow* window, double x, double y) {
        if (!of(window).player_) of(window).wheel({x, y});
    });
    glfwSetKeyCallback(window_, [](GLFWwindow* window, int key, int, int action, int mods) {
        if (!of(window).player_)
            of(window).key(key, action != GLFW_RELEASE, mods & GLFW_MOD_SHIFT,
                           mods & GLFW_MOD_CONTROL);
    });
    glfwSetCharCallback(window_, [](GLFWwindow* window, unsigned unicode) {
        if (!of(window).player_) of(window).character(unicode);
    });
    glfwSetWindowRefreshCallback(window_, [](GLFWwindow* window) { of(window).touched_ = true; });
    glfwSetFramebufferSizeCallback(
        window_, [](GLFWwindow* window, int, int) { of(window).touched_ = true; });
    glfwSetWindowFocusCallback(window_, [](GLFWwindow* window, int focused) {
        ImGui_ImplGlfw_WindowFocusCallback(window, focused);
        of(window).touched_ = true;
    });
    glfwSetWindowCloseCallback(window_, [](GLFWwindow* window) { of(window).touched_ = true; });
    glfwSetDropCallback(window_, [](GLFWwindow* window, int count, const char** paths) {
        of(window).touched_ = true;
        of(window).viewer_->handle(
            {.kind = InputEvent::Kind::drop, .files = {paths, paths + count}});
    });
}

void Window::move(const glm::dvec2& place) {
    touched_ = true;
    pointer_ = place;
    viewer_->handle({.kind = InputEvent::Kind::pointer, .seconds = glfwGetTime(), .place = place});
}

void Window::button(PointerButton button, bool down, bool shift, bool control) {
    const auto number = static_cast<std::size_t>(button);
    touched_ = true;
    down_[number] = down;
    went_down_[number] = went_down_[number] || down;
    viewer_->handle({.kind = down ? InputEvent::Kind::press : InputEvent::Kind::release,
                     .seconds = glfwGetTime(),
                     .place = pointer_,
                     .button = button,
                     .shift = shift,
                     .control = control});
}

void Window::wheel(const glm::dvec2& steps) {
    touched_ = true;
    ImGui_ImplGlfw_ScrollCallback(window_, steps.x, steps.y);
    viewer_->handle({.kind = InputEvent::Kind::wheel, .seconds = glfwGetTime(), .place = steps});
}

// ImGui takes modifiers from their own keys, so a script presses these, too.
void Window::key(int key, bool down, bool shift, bool control) {
    if (key < 0) return;  // unknown to GLFW
    touched_ = true;
    const int action = down ? GLFW_PRESS : GLFW_RELEASE;
    if (player_) {
        const auto modifier = [&](bool held, int own_key) {
            ImGui_ImplGlfw_KeyCallback(window_, own_key, 0,
                                       held && down ? GLFW_PRESS : GLFW_RELEASE, 0);
        };
        modifier(shift, GLFW_KEY_LEFT_SHIFT);
        modifier(control, GLFW_KEY_LEFT_CONTROL);
    }
    ImGui_ImplGlfw_KeyCallback(window_, key, 0, action, 0);
    if (!down) return;
    viewer_->handle({.kind = InputEvent::Kind::key,
                     .seconds = glfwGetTime(),
                     .place = pointer_,
                     .key = key,
                     .shift = shift,
                     .control = control});
}

void Window::character(unsigned unicode) {
    touched_ = true;
    ImGui_ImplGlfw_CharCallback(window_, unicode);
}

void Window::set_size(int width, int height) {
    glfwSetWindowSize(window_, width, height);
}

void Window::close() {
    glfwSetWindowShouldClose(window_, GLFW_TRUE);
}

void Window::take_screenshot(const std::filesystem::path& file) {
    screenshot_ = file;
}

void Window::run() {
    while (glfwWindowShouldClose(window_) == GLFW_FALSE && !viewer_->is_closing()) {
        wait_for_events();
        if (player_) {
            player_->advance(glfwGetTime());
            if (player_->done() && screenshot_.empty()) return;
        }
        frame();
    }
}

// Waits for events until a frame is needed.
void Window::wait_for_events() {
    // While the camera moves, the processor is left to the picture.
    if (frames_left_ > 0 && !viewer_->awaits_moving_picture()) {
        --frames_left_;
        return glfwPollEvents();
    }
    touched_ = false;
    for (;;) {
        // busy is read first: work that ends after that sets news_, so no news is lost.
        const bool busy = viewer_->is_busy();
        if (touched_ || news_.exchange(false)) break;
        const double now = glfwGetTime();
        const std::optional<double> due = next_frame(now);
        if (due && *due <= now) {
            glfwPollEvents();
            break;
        }
        double pause = due ? *due - now : INFINITY;
        if (busy) pause = std::min(pause, busy_pause);
        if (pause == INFINITY)
            glfwWaitEvents();
        else
            glfwWaitEventsTimeout(pause);
    }
    frames_left_ = 2;
}

std::optional<double> Window::next_frame(double now) const {
    const std::optional<double> next = viewer_->next_frame();
    const std::optional<double> then = player_ ? player_->next(now) : std::nullopt;
    return next && then ? std::min(*next, *then) : next ? next : then;
}

// Passes a button that went down to ImGui for at least one frame, even if it is up again.
void Window::give_input_to_imgui() {
    ImGuiIO& io = ImGui::GetIO();
    io.MousePos = pointer_.x < 0
                      ? ImVec2(-FLT_MAX, -FLT_MAX)
                      : ImVec2(static_cast<float>(pointer_.x), static_cast<float>(pointer_.y));
    for (std::size_t i = 0; i < down_.size(); ++i)
        io.MouseDown[i] = down_[i] || std::exchange(went_down_[i], false);
}

void Window::frame() {
    const double began = glfwGetTime();
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    give_input_to_imgui();
    ImGui::NewFrame();
    const ImGuiIO& io = ImGui::GetIO();
    viewer_->frame(io.DisplaySize.x, io.DisplaySize.y, io.DisplayFramebufferScale.x, began);
    ImGui::Render();
    int width = 0, height = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    gl_.Viewport(0, 0, width, height);
    gl_.ClearColor(.1f, .1f, .1f, 1);
    gl_.Clear(GL_COLOR_BUFFER_BIT);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
    if (!screenshot_.empty()) write_screenshot(width, height);
    glfwSwapBuffers(window_);
    if (player_) measure(began);
    if (std::string title = viewer_->title(); title != title_) {
        title_ = std::move(title);
        glfwSetWindowTitle(window_, title_.c_str());
    }
    if (const auto size = viewer_->take_wanted_size()) set_size(size->x, size->y);
}

void Window::measure(double began) {
    player_->measurements().add_frame(1000 * (glfwGetTime() - began));
    const Shown& shown = viewer_->shown();
    if (shown.kind != PictureKind::moving || shown.asked_at == measured_) return;
    measured_ = shown.asked_at;
    const auto since = std::chrono::steady_clock::now() - shown.asked_at;
    player_->measurements().add_latency(std::chrono::duration<double, std::milli>(since).count());
}

// Writes the window's pixels from top to bottom; OpenGL's first row is the lowest.
void Window::write_screenshot(int width, int height) {
    std::vector<std::uint8_t> codes(4 * static_cast<std::size_t>(width) *
                                    static_cast<std::size_t>(height));
    gl_.PixelStorei(GL_PACK_ALIGNMENT, 1);
    gl_.ReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, codes.data());
    Image picture(width, height);
    picture.space = ImageColorSpace::display;
    for (int row = 0; row < height; ++row) {
        const std::uint8_t* const from = &codes[4 * static_cast<std::size_t>(height - 1 - row) *
                                                static_cast<std::size_t>(width)];
        std::transform(from, from + 4 * width, picture.pixel(0, row),
                       [](std::uint8_t code) { return static_cast<float>(code) / 255; });
        for (int column = 0; column < width; ++column) picture.pixel(column, row)[3] = 1;
    }
    save_picture(picture, std::exchange(screenshot_, {}));
}

}  // namespace lamina::view
