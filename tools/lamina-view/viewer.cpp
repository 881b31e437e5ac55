// SPDX-License-Identifier: Apache-2.0
#include "viewer.h"

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <functional>

#include "panels/help_window.h"
#include "panels/theme.h"

namespace lamina::view {
namespace {

constexpr float side_width = 25, bottom_height = 19, status_height = 1.8f;  // of the font's height

constexpr ImGuiWindowFlags fixed_window = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                                          ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
                                          ImGuiWindowFlags_NoSavedSettings |
                                          ImGuiWindowFlags_NoBringToFrontOnFocus;

void begin_fixed(const char* name, float x, float y, float width, float height) {
    ImGui::SetNextWindowPos({x, y});
    ImGui::SetNextWindowSize({width, height});
    ImGui::Begin(name, nullptr, fixed_window);
}

}  // namespace

Viewer::Viewer(const GladGLContext& gl, const SessionOptions& options, std::function<void()> wake)
    : worker_(options, std::move(wake)),
      texture_(gl),
      panels_(make_panels()),
      shown_(worker_.shown()) {}

void Viewer::open(const std::filesystem::path& file) {
    try {
        document_.open(load_scene(file));
        message_.clear();
    } catch (const std::exception& error) {
        message_ = error.what();
    }
}

void Viewer::handle(const InputEvent& event) {
    if (event.kind == InputEvent::Kind::drop && !event.files.empty()) open(event.files.front());
}

std::string Viewer::title() const {
    if (!document_.is_open()) return "lamina";
    return fmt::format("{}{} - lamina", document_.scene().file.filename().string(),
                       document_.dirty() ? " *" : "");
}

void Viewer::follow_worker() {
    shown_ = worker_.shown();
    if (shown_->chosen && shown_->chosen_of == document_.revisions())
        document_.take_chosen(*shown_->chosen);
    if (shown_->screen && shown_->screen != uploaded_) {
        texture_.show(*shown_->screen);
        uploaded_ = shown_->screen;
    }
}

void Viewer::request_picture() {
    if (!document_.is_open() || document_.revisions() == requested_) return;
    worker_.request({document_.scene(), document_.revisions()});
    requested_ = document_.revisions();
}

void Viewer::frame(float width, float height, float pixels) {
    follow_worker();
    take_keys();
    const float below = em(bottom_height) + em(status_height);
    const float picture_width = std::max(width - em(side_width), 1.f);
    const float picture_height = std::max(height - below, 1.f);
    if (document_.is_open() && document_.size_follows_window)
        document_.set_size(static_cast<int>(picture_width * pixels),
                           static_cast<int>(picture_height * pixels));
    draw_picture(picture_width, picture_height, pixels);
    begin_fixed("side", picture_width, 0, em(side_width), height - em(status_height));
    draw_panels(PanelPlace::side);
    ImGui::End();
    begin_fixed("bottom", 0, picture_height, picture_width, em(bottom_height));
    draw_panels(PanelPlace::bottom);
    ImGui::End();
    draw_status(width, height);
    help_window(help_);
    // What is done in one go can be undone in one go.
    const bool* const keys = ImGui::GetIO().KeysDown;
    if (!ImGui::IsAnyItemActive() && !ImGui::IsAnyMouseDown() &&
        std::none_of(keys, keys + IM_ARRAYSIZE(ImGui::GetIO().KeysDown), std::identity()))
        document_.end_step();
    request_picture();
}

void Viewer::take_keys() {
    const ImGuiIO& io = ImGui::GetIO();
    const auto pressed = [](ImGuiKey key) {
        return ImGui::IsKeyPressed(ImGui::GetKeyIndex(key), false);
    };
    if (ImGui::IsKeyPressed(GLFW_KEY_F1, false)) help_ = !help_;
    if (!io.KeyCtrl || io.WantTextInput) return;
    if (pressed(ImGuiKey_Y) || (pressed(ImGuiKey_Z) && io.KeyShift))
        document_.redo();
    else if (pressed(ImGuiKey_Z))
        document_.undo();
}

void Viewer::draw_picture(float width, float height, float pixels) {
    if (!uploaded_) return;
    // One pixel of the picture is one of the screen, unless it is coarse or does not fit.
    const bool coarse = shown_->kind == PictureKind::moving;
    const float across = static_cast<float>(coarse ? document_.scene().width : texture_.width());
    const float down = static_cast<float>(coarse ? document_.scene().height : texture_.height());
    const float scale = std::min({1 / pixels, width / across, height / down});
    const float left = std::floor((width - scale * across) / 2);
    const float top = std::floor((height - scale * down) / 2);
    ImGui::GetBackgroundDrawList()->AddImage(
        reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture_.name())), {left, top},
        {left + scale * across, top + scale * down});
}

void Viewer::draw_panels(PanelPlace place) {
    PanelContext context{document_, *shown_, {}};
    for (const auto& panel : panels_) {
        if (panel->place() != place) continue;
        if (place == PanelPlace::bottom)
            panel->draw(context);
        else if (ImGui::CollapsingHeader(panel->title(), ImGuiTreeNodeFlags_DefaultOpen))
            panel->draw(context);
    }
}

void Viewer::draw_status(float width, float height) {
    begin_fixed("status", 0, height - em(status_height), width, em(status_height));
    if (!message_.empty())
        ImGui::TextUnformatted(message_.c_str());
    else if (!shown_->failure.empty())
        ImGui::TextUnformatted(shown_->failure.c_str());
    else if (!shown_->activity.empty())
        ImGui::Text("%s %.0f %%", shown_->activity.c_str(), 100 * shown_->share_done);
    else if (!document_.is_open())
        ImGui::TextUnformatted("Drop a scene or a data file here");
    ImGui::End();
}

}  // namespace lamina::view
