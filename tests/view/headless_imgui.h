// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <imgui.h>

namespace lamina::test {

// ImGui without a window: draw lists are made and dropped.
class HeadlessImGui {
  public:
    HeadlessImGui() {
        ImGui::CreateContext();
        ImGuiIO& io = ImGui::GetIO();
        io.IniFilename = nullptr;
        io.DisplaySize = {1200, 9000};
        unsigned char* pixels = nullptr;
        int width = 0, height = 0;
        io.Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
        // A backend maps ImGui's keys to its own codes. Here each key is its own code.
        for (int key = 0; key < ImGuiKey_COUNT; ++key) io.KeyMap[key] = key;
    }
    ~HeadlessImGui() { ImGui::DestroyContext(); }
    HeadlessImGui(const HeadlessImGui&) = delete;
    HeadlessImGui& operator=(const HeadlessImGui&) = delete;

    // Draws a frame with one window, which `contents` fills.
    template <typename Contents>
    void frame(const Contents& contents) {
        ImGui::GetIO().DeltaTime = 1.f / 60;
        ImGui::NewFrame();
        ImGui::SetNextWindowPos({0, 0});
        ImGui::SetNextWindowSize(size);
        ImGui::Begin("window", nullptr, ImGuiWindowFlags_NoDecoration);
        contents();
        ImGui::End();
        ImGui::Render();
    }

    ImVec2 size{500, 9000};
};

}  // namespace lamina::test
