// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "comparison_view.h"
#include "model/document.h"
#include "model/frame_history.h"
#include "model/navigator.h"
#include "model/viewer_settings.h"
#include "panels/panel.h"
#include "panels/typed_input.h"
#include "work/draw_worker.h"
#include "work/saving.h"

namespace lamina::view {

// The window's main loop: input changes the document, the worker draws it, and a frame shows the
// picture.
class Viewer {
  public:
    // `wake` is called, from any thread, when there is something new to be shown. `settings_file`:
    // empty if none is kept.
    Viewer(const GladGLContext& gl, const SessionOptions& options, std::function<void()> wake,
           std::filesystem::path settings_file);
    ~Viewer();

    // Opens a scene or data file. What is wrong with it is shown.
    void open(const std::filesystem::path& file);
    // Saves the full picture once it is there. Returns what is wrong with the name, or an empty
    // text.
    std::string save(const std::filesystem::path& file);
    void set_trace(bool trace);
    void set_coarse(bool coarse);
    void show_panels(bool panels);
    void fix_size(int width, int height);  // of the picture, whatever the window's
    // Returns the size that the window needs for a picture of another size that is to be seen pixel
    // by pixel.
    std::optional<glm::ivec2> take_wanted_size();

    void handle(const InputEvent& event);
    // Declares the window's contents to ImGui. `width`, `height`: of the window, in ImGui's units;
    // `pixels`: of the screen for one of them; `seconds`: now.
    void frame(float width, float height, float pixels, double seconds);
    // Returns the time at which a frame is needed even without input.
    std::optional<double> next_frame() const;
    std::string title() const;
    bool is_closing() const { return closing_; }

    const Shown& shown() const { return *shown_; }
    // States of the last request: drawn in full, and traced to its end. A request that cannot be
    // drawn counts as at rest, too.
    bool is_full() const;
    bool is_truth() const;
    bool is_saving() const { return !waiting_.empty() || saving_.busy(); }
    bool is_failed() const;
    bool is_busy() const { return worker_.busy() || saving_.busy(); }
    bool awaits_moving_picture() const { return requested_.moving && worker_.busy(); }
    std::string failure() const;  // what is wrong, or empty

  private:
    void follow_worker();
    void go_back_if_failed();
    void request_picture(double seconds);
    void save_what_waits();
    void take_key(const InputEvent& event);
    CameraControl::Around around() const;
    void find_value();
    void ask_open();
    void ask_save(const char* suffix);
    void draw_menu();
    void draw_file_menu();
    void draw_view_menu();
    void draw_picture(float left, float top, float width, float height, float pixels);
    void take_comparison_key(int key);
    void draw_comparison();
    void draw_side_panels();
    void draw_bottom_panels();
    PanelContext panel_context();
    void draw_status(float width, float height);
    std::string status() const;

    std::filesystem::path settings_file_;
    ViewerSettings settings_;
    Document document_, before_;  // before_: while a file is opened, the one that was open
    DrawWorker worker_;
    Saving saving_;
    PictureTexture texture_;
    ComparisonView comparison_view_;
    PrecisionInSight precision_;
    std::vector<std::unique_ptr<Panel>> panels_;
    PathPrompt prompt_;
    CameraControl control_;
    PictureArea area_;
    glm::dvec2 pointer_{-1};
    std::optional<SeenPoint> seen_;  // under the pointer

    std::shared_ptr<const Shown> shown_;
    std::shared_ptr<const ScreenPicture> uploaded_;
    DrawRequest requested_;  // without its scene
    std::uint64_t requests_ = 0;
    std::optional<DrawRequest::Clock::time_point> input_at_;  // of what is not requested yet
    std::uint64_t opened_ = 0;  // Revisions::data of the last file that could be opened
    bool wants_size_ = false;
    glm::vec2 beside_{0};  // of the window, what is not the picture's
    float pixels_ = 1;
    double changed_at_ = 0;  // when something was last changed while it was dragged
    std::vector<std::filesystem::path> waiting_;  // to be saved
    std::string message_;                         // of what went wrong or was done last
    bool bad_ = false;                            // it went wrong
    bool help_ = false, closing_ = false;
};

}  // namespace lamina::view
