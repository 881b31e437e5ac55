// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "model/input_event.h"
#include "model/document.h"
#include "panels/panel.h"
#include "picture_texture.h"
#include "work/draw_worker.h"

namespace lamina::view {

// What happens in the window: input changes the document, the worker draws it, and a frame shows
// that.
class Viewer {
  public:
    // `wake` is called, from any thread, when there is something new to be shown.
    Viewer(const GladGLContext& gl, const SessionOptions& options, std::function<void()> wake);

    // A scene or data file. What is wrong with it is shown.
    void open(const std::filesystem::path& file);
    void handle(const InputEvent& event);  // what ImGui does not take
    // Declares the window's contents to ImGui. `width`, `height`: of the window, in ImGui's units;
    // `pixels`: of the screen for one of them.
    void frame(float width, float height, float pixels);
    std::string title() const;
    bool is_closing() const { return closing_; }

  private:
    void follow_worker();
    void request_picture();
    void take_keys();
    void draw_picture(float width, float height, float pixels);
    void draw_panels(PanelPlace place);
    void draw_status(float width, float height);

    Document document_;
    DrawWorker worker_;
    PictureTexture texture_;
    std::vector<std::unique_ptr<Panel>> panels_;
    std::shared_ptr<const Shown> shown_;
    std::shared_ptr<const ScreenPicture> uploaded_;
    Revisions requested_;
    std::string message_;  // of what went wrong last
    bool help_ = false, closing_ = false;
};

}  // namespace lamina::view
